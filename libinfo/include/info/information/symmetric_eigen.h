#pragma once

#include <Eigen/Dense>

namespace info {

/// A = V·diag(λ)·Vᵀ of a symmetric matrix.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< λ, rising
  Eigen::MatrixXd vectors;  ///< V: one orthonormal column per value
};

/// Eigenvalues and eigenvectors of a symmetric matrix; its lower triangle is read. Entries that are
/// not finite give results that are not finite. This is Eigen's solver, compiled only once because
/// it takes long to compile.
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix);

/// The eigenvalues alone, in ascending order.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace info
