#include "info/information/symmetric_eigen.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace info {

void requireSymmetric(const Eigen::MatrixXd& matrix, const std::string& what,
                      const std::function<std::string(Eigen::Index)>& nameOf) {
  for (Eigen::Index j = 0; j < matrix.rows(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      const double size = std::sqrt(std::abs(matrix(i, i) * matrix(j, j)));
      if (std::abs(matrix(i, j) - matrix(j, i)) <= 1e-6 * size) continue;
      throw std::invalid_argument(fmt::format(
          "{}: the information matrix must be symmetric, but entry ({}, {}) is {} and ({}, {}) is "
          "{}",
          what, nameOf(i), nameOf(j), matrix(i, j), nameOf(j), nameOf(i), matrix(j, i)));
    }
  }
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
