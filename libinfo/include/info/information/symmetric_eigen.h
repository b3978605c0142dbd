#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>

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

/// Requires a finite square matrix to be symmetric: |a_ij − a_ji| ≤ 1e-6·√|a_ii·a_jj|, whatever the
/// units. One that was written with six digits and read again is symmetric.
/// @param what   whose matrix it is, for the message
/// @param nameOf the row or column with this index, for the message
/// @throws std::invalid_argument that names the two entries
void requireSymmetric(const Eigen::MatrixXd& matrix, const std::string& what,
                      const std::function<std::string(Eigen::Index)>& nameOf);

/// The eigenvalues alone, in ascending order.
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace info
