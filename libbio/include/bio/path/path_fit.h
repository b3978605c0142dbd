#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// Lengths of one path in postures, one row each.
struct SampledPath {
  std::vector<std::string> coordinates;  ///< those that change it
  Eigen::MatrixXd q;                     ///< rows × coordinates [rad] or [m]
  Eigen::VectorXd length;                ///< [m]
  Eigen::MatrixXd slope;                 ///< ∂ℓ/∂q, rows × coordinates; no rows: not known
};

struct PathFitOptions {
  double tolerance = 1e-4;  ///< for the largest error of a length [m] > 0
  int maxOrder = 9;         ///< as in OpenSim's PolynomialPathFitter, 1 to 9
};

struct FitError {
  double rms = 0;      ///< [m]
  double largest = 0;  ///< [m]
};

/// A polynomial in place of a path.
struct PathFit {
  PathFunction function;
  bool meetsTolerance = false;
  FitError length;  ///< over all postures, fitted or held back
  FitError arm;     ///< of ∂ℓ/∂q of each coordinate [m/rad]; NaN where slopes are not known
  std::size_t postures = 0;
};

/// The polynomial of least order that is within the tolerance of every length, held back or not;
/// the best one of all orders if none is. Of each order the one with the least
///     Σ (ℓ − p)² + Σ_i (w h_i (∂_iℓ − ∂_ip))²,   w = 1/4, h_i half of the range of q_i
/// over `fitted`: normal equations in Legendre polynomials of (q − middle)/h, whose coefficients
/// are then those of powers of q. Orders that would have more than 1300 terms, or more than half as
/// many as there are equations, are not tried.
/// @param held  postures that only judge it; may have no rows
/// @throws std::invalid_argument no coordinate or more than MultivariatePolynomial::maxDimension, a
///   coordinate that does not vary, too few postures for order 1, options out of their range
PathFit fitPolynomial(const SampledPath& fitted, const SampledPath& held,
                      const PathFitOptions& options);

}  // namespace bio
