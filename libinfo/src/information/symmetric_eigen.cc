#include "info/information/symmetric_eigen.h"

#include <cmath>

namespace info {

std::optional<std::pair<Eigen::Index, Eigen::Index>> asymmetricPair(const Eigen::MatrixXd& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double size = std::sqrt(std::abs(matrix(i, i) * matrix(j, j)));
      if (!(std::abs(matrix(i, j) - matrix(j, i)) <= 1e-6 * size)) return {{j, i}};
    }
  }
  return {};
}

SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace info
