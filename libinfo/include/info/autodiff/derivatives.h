#pragma once

#include <algorithm>
#include <cmath>

#include "info/autodiff/dual.h"

namespace info {

namespace detail {

/// Directions per evaluation: all of them if their number is fixed and small, else blocks of 4.
constexpr int directionBlock(int size) {
  return size > 0 && size <= 8 ? size : 4;
}

}  // namespace detail

/// A function's value and first derivatives.
template <int Rows, int Columns>
struct Linearisation {
  Vector<double, Rows> value;              ///< F(z)
  Matrix<double, Rows, Columns> jacobian;  ///< ∂F/∂z, row i column j: ∂F_i/∂z_j
};

/// The value F(z) and the Jacobian ∂F/∂z of a function that is a template over its scalar.
///
/// Exact up to rounding, by forward automatic differentiation in blocks of directions.
/// @param function callable as function(Vector<T, N>) → Vector<T, rows> for T = double and Dual
template <class F, int N>
auto differentiate(const F& function, const Vector<double, N>& z) {
  constexpr int block = detail::directionBlock(N);
  using Scalar = Dual<block>;
  using Image = decltype(function(Vector<Scalar, N>(z.size())));
  constexpr int rows = Image::RowsAtCompileTime;
  Linearisation<rows, N> out;
  Vector<Scalar, N> seeded(z.size());
  const Eigen::Index n = z.size();
  for (Eigen::Index first = 0; first == 0 || first < n; first += block) {
    // seed one block of directions, take its columns of the Jacobian
    for (Eigen::Index j = 0; j < n; ++j) {
      seeded[j].value() = z[j];
      seeded[j].derivatives().setZero();
      if (j >= first && j < first + block) seeded[j].derivatives()[j - first] = 1.0;
    }
    const Image image = function(seeded);
    if (first == 0) {
      out.value.resize(image.size());
      out.jacobian.resize(image.size(), n);
    }
    for (Eigen::Index i = 0; i < image.size(); ++i) {
      out.value[i] = image[i].value();
      for (Eigen::Index j = first; j < std::min<Eigen::Index>(first + block, n); ++j)
        out.jacobian(i, j) = image[i].derivatives()[j - first];
    }
  }
  return out;
}

/// ∂F/∂z by automatic differentiation, see differentiate().
template <class F, int N>
auto jacobian(const F& function, const Vector<double, N>& z) {
  return differentiate(function, z).jacobian;
}

/// The contraction Σ_i w_i ∂²F_i/∂z² [N × N, symmetric]: one Hessian, not a tensor of them.
template <class F, int N, int Rows>
Matrix<double, N, N> contractedHessian(const F& function, const Vector<double, N>& z,
                                       const Vector<double, Rows>& w) {
  constexpr int block = detail::directionBlock(N);
  using Inner = Dual<block>;
  using Outer = Dual<block, Inner>;
  const Eigen::Index n = z.size();
  Matrix<double, N, N> hessian(n, n);
  hessian.setZero();
  Vector<Outer, N> seeded(n);
  for (Eigen::Index row = 0; row < n; row += block) {
    for (Eigen::Index column = 0; column <= row; column += block) {
      for (Eigen::Index j = 0; j < n; ++j) {
        Inner value(z[j]);
        if (j >= column && j < column + block) value.derivatives()[j - column] = 1.0;
        seeded[j].value() = value;
        for (Eigen::Index d = 0; d < block; ++d)
          seeded[j].derivatives()[d] = Inner(j == row + d ? 1.0 : 0.0);
      }
      const auto image = function(seeded).eval();
      for (Eigen::Index i = 0; i < image.size(); ++i)
        for (Eigen::Index d = 0; d < block && row + d < n; ++d)
          for (Eigen::Index e = 0; e < block && column + e < n; ++e)
            hessian(row + d, column + e) += w[i] * image[i].derivatives()[d].derivatives()[e];
      if (column < row) {
        const Eigen::Index rows = std::min<Eigen::Index>(block, n - row);
        const Eigen::Index columns = std::min<Eigen::Index>(block, n - column);
        hessian.block(column, row, columns, rows) =
            hessian.block(row, column, rows, columns).transpose().eval();
      }
    }
  }
  return hessian;
}

/// Reference for jacobian(): central differences with steps h·max(1, |z_j|), error O(h²) + O(ε/h).
/// @param relativeStep h > 0; 6e-6 = ∛ε balances the two errors
template <class F, int N>
auto finiteDifferenceJacobian(const F& function, const Vector<double, N>& z,
                              double relativeStep = 6e-6) {
  using Image = decltype(function(z));
  constexpr int rows = Image::RowsAtCompileTime;
  const Image centre = function(z);
  Matrix<double, rows, N> out(centre.size(), z.size());
  Vector<double, N> moved = z;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double h = relativeStep * std::max(1.0, std::abs(z[j]));
    moved[j] = z[j] + h;
    const Image plus = function(moved);
    moved[j] = z[j] - h;
    const Image minus = function(moved);
    moved[j] = z[j];
    out.col(j) = (plus - minus) / (2.0 * h);
  }
  return out;
}

}  // namespace info
