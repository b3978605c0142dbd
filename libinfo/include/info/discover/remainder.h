#pragma once

#include "info/discover/joint_fit.h"

namespace info::discover {

/// Evidence that what a fit leaves to chance is a force with a cause: log Z with a further force
/// that follows something, less log Z without [nats].
struct RemainderEvidence {
  double ofState = 0;   ///< f(q, q̇), smooth and otherwise unknown
  double ofInputs = 0;  ///< Σ c_ij·u_i(t − t_j), every input i, t_j = 0, 0.05 … 0.2 s
};

/// f is a Gaussian process over the states at the latent force's nodes, each coordinate scaled by
/// its standard deviation, covariance s²·exp(−½|x − x′|²), in the 15 directions that carry most of
/// it; c_ij ~ N(0, s²) with each input scaled by its standard deviation. With score g and
/// information S of these directions, everything that is free in the fit projected out,
///     log B(s) = ½ gᵀ(S + 1/s²)⁻¹g − ½ log|1 + s²S|
/// and the best of five sizes s counts, less log 5 for the choice. A force that came from errors
/// of the inputs falls anywhere; one that came from an effect that no name fits does not.
RemainderEvidence remainderEvidence(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
