#pragma once

#include <Eigen/Dense>

namespace info {

/// Probability that Σ v_i z_i², z_i ~ N(0, 1) independent, is larger than q: the tail of a
/// quadratic form in normal variables whose covariance has the eigenvalues v.
///
/// Saddlepoint approximation of Lugannani and Rice (Kuonen, "Saddlepoint approximations for
/// distributions of quadratic forms in normal variables", Biometrika 86, 1999): with
/// K(s) = −½ Σ ln(1 − 2 s v_i) and K'(s) = q,
///     w = sign(s)·√(2(s·q − K)),   u = s·√K'',   P = 1 − Φ(w + ln(u/w)/w)
/// The relative error is at most a few per cent, also far out in the tail.
/// @param variances  v ≥ 0, at least one > 0
/// @throws std::invalid_argument if none is > 0, or one is negative or not finite
double tailOfSquares(const Eigen::VectorXd& variances, double q);

}  // namespace info
