#pragma once

#include <Eigen/Dense>

namespace info {

/// Correlation of quantities with arbitrary marginal distributions by a Gaussian copula.
///
/// z = Λ·Φ⁻¹(u), shares = Φ(z), with ΛΛᵀ the correlation: independent u, uniform on (0, 1), give
/// correlated shares that are each uniform. Marginal::quantile turns them into samples. For normal
/// marginals with distant bounds these have exactly the multivariate normal distribution; if a
/// bound truncates, the marginals are exact and the correlation is that before truncation.
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
