#pragma once

#include <Eigen/Dense>

namespace info {

/// A = V·diag(λ)·Vᵀ of a symmetric matrix.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< λ, rising
  Eigen::MatrixXd vectors;  ///< V: one orthonormal column per value
};

/// Eigenvalues and eigenvectors of a symmetric matrix; its lower triangle is read. Not finite
/// entries give results that are not finite. Eigen's solver, compiled once: it is the costliest of
/// all to compile.
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& matrix);

/// The eigenvalues alone, rising.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace info
