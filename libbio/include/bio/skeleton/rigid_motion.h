#pragma once

#include <Eigen/Dense>
#include <array>

namespace bio {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

/// Number of distinct second derivatives of a function of n variables, and the index of (i, j).
constexpr int numPairs(int n) {
  return n * (n + 1) / 2;
}
constexpr int pairIndex(int i, int j) {
  return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
}

/// A rigid placement X: p_A = R p_B + p.
template <class T>
struct Placement {
  Eigen::Matrix<T, 3, 3> R = Eigen::Matrix<T, 3, 3>::Identity();
  Eigen::Matrix<T, 3, 1> p = Eigen::Matrix<T, 3, 1>::Zero();
};

template <class T>
Placement<T> operator*(const Placement<T>& a, const Placement<T>& b) {
  Placement<T> c;
  c.R.noalias() = a.R * b.R;
  c.p.noalias() = a.R * b.p + a.p;
  return c;
}

template <class T>
Placement<T> inverse(const Placement<T>& a) {
  Placement<T> c;
  c.R = a.R.transpose();
  c.p.noalias() = -(c.R * a.p);
  return c;
}

/// A placement that moves with N coordinates q, with its first and second derivatives:
/// value X, first[i] = ∂X/∂q_i, second[pairIndex(i, j)] = ∂²X/∂q_i∂q_j (R and p each; a derivative
/// is no placement itself, only its pair of matrices).
template <class T, int N>
struct RigidMotion {
  Placement<T> value;
  std::array<Placement<T>, N> first;
  std::array<Placement<T>, numPairs(N)> second;
};

/// A point that moves with N coordinates [m].
template <class T, int N>
struct PointMotionJet {
  Eigen::Matrix<T, 3, 1> value;
  std::array<Eigen::Matrix<T, 3, 1>, N> first;
  std::array<Eigen::Matrix<T, 3, 1>, numPairs(N)> second;
};

/// The identity: a frame that does not move.
template <class T, int N>
RigidMotion<T, N> identityMotion() {
  RigidMotion<T, N> motion;
  const Placement<T> zero{Eigen::Matrix<T, 3, 3>::Zero(), Eigen::Matrix<T, 3, 1>::Zero()};
  motion.first.fill(zero);
  motion.second.fill(zero);
  return motion;
}

/// A fixed point of the moving frame, seen from the frame it moves in.
template <class T, int N, class Point>
PointMotionJet<T, N> movePoint(const RigidMotion<T, N>& X, const Point& point) {
  PointMotionJet<T, N> jet;
  // lazily evaluated: faster for three numbers
  jet.value.noalias() = X.value.R.lazyProduct(point) + X.value.p;
  for (std::size_t i = 0; i < N; ++i) {
    jet.first[i].noalias() = X.first[i].R.lazyProduct(point) + X.first[i].p;
  }
  for (std::size_t ij = 0; ij < numPairs(N); ++ij) {
    jet.second[ij].noalias() = X.second[ij].R.lazyProduct(point) + X.second[ij].p;
  }
  return jet;
}

namespace detail {

/// (Ra, pa)·(Rb, pb) where the left factor is a derivative: no bottom row carries pa over twice.
template <class T>
void addProduct(Placement<T>& sum, const Placement<T>& a, const Placement<T>& b, bool keepShift) {
  sum.R.noalias() += a.R * b.R;
  sum.p.noalias() += a.R * b.p;
  if (keepShift) sum.p += a.p;
}

}  // namespace detail

/// Motion of B in A and of C in B chained: motion of C in A, by the product rule.
template <class T, int N>
RigidMotion<T, N> chain(const RigidMotion<T, N>& a, const RigidMotion<T, N>& b) {
  RigidMotion<T, N> c = identityMotion<T, N>();
  c.value = a.value * b.value;
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    detail::addProduct(c.first[si], a.first[si], b.value, true);
    detail::addProduct(c.first[si], a.value, b.first[si], false);
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      detail::addProduct(c.second[ij], a.second[ij], b.value, true);
      detail::addProduct(c.second[ij], a.first[si], b.first[sj], false);
      detail::addProduct(c.second[ij], a.first[sj], b.first[si], false);
      detail::addProduct(c.second[ij], a.value, b.second[ij], false);
    }
  }
  return c;
}

/// Motion of A seen from B, given that of B in A.
template <class T, int N>
RigidMotion<T, N> invert(const RigidMotion<T, N>& a) {
  RigidMotion<T, N> c = identityMotion<T, N>();
  c.value = inverse(a.value);
  // p = −Rᵀ p_A: first and second derivatives by the product rule
  for (int i = 0; i < N; ++i) {
    const auto si = static_cast<std::size_t>(i);
    c.first[si].R = a.first[si].R.transpose();
    c.first[si].p.noalias() = -(a.first[si].R.transpose() * a.value.p);
    c.first[si].p.noalias() -= a.value.R.transpose() * a.first[si].p;
    for (int j = 0; j <= i; ++j) {
      const auto sj = static_cast<std::size_t>(j);
      const auto ij = static_cast<std::size_t>(pairIndex(i, j));
      c.second[ij].R = a.second[ij].R.transpose();
      c.second[ij].p.noalias() = -(a.second[ij].R.transpose() * a.value.p);
      c.second[ij].p.noalias() -= a.first[si].R.transpose() * a.first[sj].p;
      c.second[ij].p.noalias() -= a.first[sj].R.transpose() * a.first[si].p;
      c.second[ij].p.noalias() -= a.value.R.transpose() * a.second[ij].p;
    }
  }
  return c;
}

}  // namespace bio
