#pragma once

#include <Eigen/Dense>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Expected root mean square of ỹ − y of a fit in held-out trials, if its model were true:
/// parameters that the fitted trials leave uncertain change the simulation of other trials, and no
/// calibration on the same trials can do better.
///
/// With Γ = dy/dξ of the parameters shared with the fit, cov(ξ) their posterior covariance, W =
/// dy/dη of the latent force (inputs scatter in new trials as well), and the initial states of the
/// held-out trials fitted to them, S = dy/d(start), so that only the projection P = 1 − S(SᵀS +
/// σ_y²)⁻¹Sᵀ of the error remains,
///     E|e|² = tr P(Γ cov(ξ) Γᵀ + WWᵀ + SSᵀ + σ_y²)Pᵀ,   the result is √(E|e|²/N)
///
/// The sum of squares is a quadratic form in normal variables; `probability` is the probability of
/// at least the observed value (tailOfSquares).
/// @param held the held-out trials
/// @param starts startsOnly() fitted to them without latent force, all other values from `fit`
/// @param fit the fit of the other trials
/// @throws std::invalid_argument if `starts` is of other trials
struct ExpectedError {
  double rms = 0;                        ///< √(E|e|²/N) [unit of the output]
  Eigen::VectorXd variances;             ///< of e, along its principal axes
  double probability(double rms) const;  ///< of an error at least as large
};
ExpectedError expectedError(const Likelihood& held, const Fit& starts, const Fit& fit);

}  // namespace info::discover
