#pragma once

#include <Eigen/Dense>

namespace info {

/// How numbers with laws of their own hang together: as the components of a normal vector do.
///
/// z = Λ·Φ⁻¹(u), shares = Φ(z), with ΛΛᵀ the correlation: from independent u, even on (0, 1), come
/// shares that are even each by itself and correlated. Handed to Marginal::quantile they are draws:
/// with normal laws whose bounds are far away, of the normal law of that covariance exactly; where
/// a bound cuts, the laws stay as they are said and the correlation is that before cutting.
class GaussianCopula {
 public:
  /// @param correlation symmetric, 1 on the diagonal
  /// @throws std::invalid_argument if it is not symmetric, not of ones, or not positive definite:
  ///   its smallest eigenvalue must be at least 1e-10
  explicit GaussianCopula(const Eigen::MatrixXd& correlation);

  /// @param independent u, each 0 to 1
  Eigen::VectorXd shares(const Eigen::VectorXd& independent) const;

 private:
  Eigen::MatrixXd lower_;  ///< Λ
};

}  // namespace info
