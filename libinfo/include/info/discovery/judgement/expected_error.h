#pragma once

#include <Eigen/Dense>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Root mean square of ỹ − y that is to be expected of a fit in trials that it has not seen, were
/// its model true: what fitted trials leave unknown moves the simulation of others, and no
/// calibration of the same trials gets below that.
///
/// With Γ = dy/dξ of what the fit determines, cov(ξ) its posterior, W = dy/dη of its latent force
/// (inputs scatter in new trials, too) and the trials' own starts S fitted to them, which takes
/// P = 1 − S(SᵀS + σ_y²)⁻¹Sᵀ off,
///     E|e|² = tr P(Γ cov(ξ) Γᵀ + WWᵀ + SSᵀ + σ_y²)Pᵀ,   the result is √(E|e|²/N)
///
/// The sum of squares is a quadratic form in normal variables; `probability` is the chance that it
/// is as large as it was (tailOfSquares).
/// @param held    of the trials in question
/// @param starts  startsOnly() fitted to them, without latent force, all else from `fit`
/// @param fit     of other trials
/// @throws std::invalid_argument if `starts` is of other trials
struct ExpectedError {
  double rms = 0;                        ///< √(E|e|²/N) [unit of the output]
  Eigen::VectorXd variances;             ///< of e, along its principal axes
  double probability(double rms) const;  ///< of an error as large as that
};
ExpectedError expectedError(const Likelihood& held, const Fit& starts, const Fit& fit);

}  // namespace info::discover
