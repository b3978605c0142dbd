#pragma once

#include <array>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// What a disturbance that a model lacks may follow.
enum class Cause {
  state,         ///< a force f(q, q̇), smooth and otherwise unknown
  inputs,        ///< a force Σ c_ij·u_i(t − t_j), every input i, t_j = 0, 0.05 … 0.2 s
  acceleration,  ///< a force c·q̈: an inertia
  sensor,  ///< the output itself: c_0 + c_1 y + c_2 y² + c_3 ẏ is measured beside it. A hint, no
           ///< test: y is smoothed, and so follows the noise that it is compared with
  moments,  ///< a force Σ_i G_i·(c_i z + d_i (z² − 1)), G the channels of the latent force's scale
            ///< but for the constant one, z the scaled output: levers whose length changes
};
inline constexpr std::array kCauses = {Cause::state, Cause::inputs, Cause::acceleration,
                                       Cause::sensor, Cause::moments};
const char* name(Cause cause);

/// Evidence that what a fit leaves to chance has a cause: log Z with a further disturbance that
/// follows it, less log Z without [nats]; 0 where there is none of the kind.
struct ResidualEvidence {
  std::array<double, kCauses.size()> nats{};  ///< in the order of kCauses
  double of(Cause cause) const { return nats[static_cast<std::size_t>(cause)]; }
  Cause strongest() const;
};

/// f is a Gaussian process over the states at the latent force's nodes, each coordinate scaled by
/// its standard deviation, covariance s²·exp(−½|x − x′|²), in the 15 directions that carry most of
/// it; the coefficients are N(0, s²), with what they multiply scaled by its standard deviation.
/// With score g and information S of these directions, everything that is free in the fit projected
/// out,
///     log B(s) = ½ gᵀ(S + 1/s²)⁻¹g − ½ log|1 + s²S|
/// and the best of five sizes s counts, less log 5 for the choice. A force that came from errors
/// of the inputs falls anywhere; one that came from an effect that no name fits does not.
ResidualEvidence residualEvidence(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
