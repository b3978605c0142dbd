#pragma once

#include <array>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Possible causes of a disturbance that is missing in a model.
enum class Cause {
  state,         ///< a force f(q, q̇), smooth and otherwise arbitrary
  inputs,        ///< a force Σ c_ij·u_i(t − t_j), every input i, t_j = 0, 0.05 … 0.2 s
  acceleration,  ///< a force c·q̈: an inertia
  sensor,  ///< an error c_0 + c_1 y + c_2 y² + c_3 ẏ of the output. An indication, not a test: the
           ///< smoothed y is correlated with the noise that it is compared with
  moments,  ///< a force Σ_i G_i·(c_i z + d_i (z² − 1)), G the non-constant channels of the latent
            ///< force's scale, z the scaled output: a scale that varies with the output
};
inline constexpr std::array kCauses = {Cause::state, Cause::inputs, Cause::acceleration,
                                       Cause::sensor, Cause::moments};
const char* name(Cause cause);

/// Evidence that the residual disturbance of a fit has a cause: log Z with a further disturbance of
/// that kind less log Z without it [nats]; 0 if the data have none of the kind.
struct ResidualEvidence {
  std::array<double, kCauses.size()> nats{};  ///< in the order of kCauses
  double of(Cause cause) const { return nats[static_cast<std::size_t>(cause)]; }
  Cause strongest() const;
};

/// f is a Gaussian process over the states at the latent force's nodes, each coordinate scaled by
/// its standard deviation, covariance s²·exp(−½|x − x′|²), in its 15 leading directions; the
/// coefficients are N(0, s²), their regressors being scaled by their standard deviations. With
/// score g and information S of these directions after elimination of all quantities that are free
/// in the fit,
///     log B(s) = ½ gᵀ(S + 1/s²)⁻¹g − ½ log|1 + s²S|
/// and the largest value over five sizes s is taken, less log 5 for the choice. A force caused by
/// errors of the inputs is unrelated to the state; one caused by a missing effect is a function of
/// it.
ResidualEvidence residualEvidence(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
