#pragma once

#include <Eigen/Dense>
// The scalar of Eigen's automatic differentiation needs the dense module first.
#include <unsupported/Eigen/AutoDiff>

namespace info {

template <class T, int N>
using Vector = Eigen::Matrix<T, N, 1>;
template <class T, int R, int C>
using Matrix = Eigen::Matrix<T, R, C, (R == 1 && C != 1) ? Eigen::RowMajor : Eigen::ColMajor>;

/// A number a + Σ b_i ε_i with ε_i ε_j = 0: carries C directional derivatives b through a function.
/// Dual<C, Dual<D>> carries second derivatives. C is fixed, so that nothing is allocated.
template <int C, class T = double>
using Dual = Eigen::AutoDiffScalar<Vector<T, C>>;

/// The plain number inside, whatever the nesting.
inline double plainValue(double x) {
  return x;
}
template <class D>
double plainValue(const Eigen::AutoDiffScalar<D>& x) {
  return plainValue(x.value());
}

}  // namespace info
