#pragma once

#include <Eigen/Dense>
#include <optional>
#include <utility>

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

/// Row and column, row < column, of a square matrix where |a_ij − a_ji| > 1e-6·√|a_ii·a_jj| or is
/// NaN: more than rounding, whatever the units. None: it is symmetric.
std::optional<std::pair<Eigen::Index, Eigen::Index>> asymmetricPair(const Eigen::MatrixXd& matrix);

/// The eigenvalues alone, in ascending order.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace info
