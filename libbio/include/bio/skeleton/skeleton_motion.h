#pragma once

// Template bodies of skeleton.h.
#include <Eigen/Dense>
#include <stdexcept>

#include "bio/skeleton/skeleton.h"
#include "info/autodiff/dual.h"

namespace bio {
namespace detail {

template <class T>
struct CurveJet {
  T value;
  T slope;
  T curvature;
};

/// f, f′ and f″ at x, for a number or an AD scalar over numbers.
template <class T>
CurveJet<T> curveJet(const FunctionEvaluator& function, const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    const CurveValue y = function.evaluate(x);
    return {y.value, y.slope, y.curvature};
  } else {
    const CurveValue y = function.evaluate(x.value());
    return {T(y.value, y.slope * x.derivatives()), T(y.slope, y.curvature * x.derivatives()),
            T(y.curvature, y.third * x.derivatives())};
  }
}

/// The turn A = aaᵀ + c(1 − aaᵀ) + sK about the unit axis a by an angle f(q_k), c = cos f, s = sin
/// f, K the cross product with a, and its derivatives in q_k.
template <class T>
struct TurnJet {
  Eigen::Matrix<T, 3, 3> A, A1, A2;
};

template <class T>
TurnJet<T> turnAbout(const Eigen::Vector3d& a, const CurveJet<T>& angle) {
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using std::cos;
  using std::sin;
  const T c = cos(angle.value);
  const T s = sin(angle.value);
  Eigen::Matrix3d skew;
  skew << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  const Matrix K = skew.cast<T>();
  const Matrix aa = (a * a.transpose()).eval().template cast<T>();
  const Matrix across = Matrix::Identity() - aa;
  const Matrix A_angle = c * K - s * across;
  return {aa + c * across + s * K, A_angle * angle.slope,
          (-(c * across + s * K)) * (angle.slope * angle.slope) + A_angle * angle.curvature};
}

}  // namespace detail

template <class T>
detail::CurveJet<T> Skeleton::amountOf(const Factor& factor, const T& q_k) {
  if (factor.isIdentity) return {q_k, T(1.0), T(0.0)};
  const auto inner = detail::curveJet(factor.coupling, q_k);
  const auto outer = detail::curveJet(factor.amount, inner.value);
  return {outer.value, T(outer.slope * inner.slope),
          T(outer.curvature * inner.slope * inner.slope + outer.slope * inner.curvature)};
}

template <class T, int N>
void Skeleton::applyFactor(RigidMotion<T, N>& X, const Factor& factor, const T& q_k) {
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Vector = Eigen::Matrix<T, 3, 1>;
  const auto k = static_cast<std::size_t>(factor.freeIndex);

  // X ← X·before, a constant
  const Matrix R_before = factor.before.R.template cast<T>();
  const Vector p_before = factor.before.p.template cast<T>();
  const auto afterConstant = [&](Placement<T>& Y) {
    Y.p += Y.R * p_before;
    Y.R = (Y.R * R_before).eval();
  };
  afterConstant(X.value);
  for (auto& Y : X.first) afterConstant(Y);
  for (auto& Y : X.second) afterConstant(Y);

  const auto pairOf = [&](std::size_t i) {
    return static_cast<std::size_t>(pairIndex(static_cast<int>(i), factor.freeIndex));
  };
  const detail::CurveJet<T> amount = amountOf(factor, q_k);
  if (factor.turns) {
    const auto [A, A1, A2] = detail::turnAbout(factor.axis, amount);
    // second derivatives first: they use the old first ones
    for (auto& Y : X.second) Y.R = (Y.R * A).eval();
    for (std::size_t i = 0; i < N; ++i) {
      X.second[pairOf(i)].R.noalias() += X.first[i].R * A1;
    }
    X.second[pairOf(k)].R.noalias() += X.first[k].R * A1 + X.value.R * A2;
    for (auto& Y : X.first) Y.R = (Y.R * A).eval();
    X.first[k].R.noalias() += X.value.R * A1;
    X.value.R = (X.value.R * A).eval();
  } else {
    const auto& [f, f1, f2] = amount;
    const Vector axis = factor.axis.template cast<T>();
    const auto along = [&](const Matrix& R) -> Vector { return R * axis; };
    for (auto& Y : X.second) Y.p += along(Y.R) * f;
    for (std::size_t i = 0; i < N; ++i) X.second[pairOf(i)].p += along(X.first[i].R) * f1;
    X.second[pairOf(k)].p += along(X.first[k].R) * f1 + along(X.value.R) * f2;
    for (auto& Y : X.first) Y.p += along(Y.R) * f;
    X.first[k].p += along(X.value.R) * f1;
    X.value.p += along(X.value.R) * f;
  }
}

template <class T, int N>
void Skeleton::applyFirstFactor(RigidMotion<T, N>& X, const Factor& factor, const T& q_k) {
  using Matrix = Eigen::Matrix<T, 3, 3>;
  using Vector = Eigen::Matrix<T, 3, 1>;
  const auto k = static_cast<std::size_t>(factor.freeIndex);
  const auto kk = static_cast<std::size_t>(pairIndex(factor.freeIndex, factor.freeIndex));
  const Matrix R = factor.before.R.template cast<T>();
  X = identityMotion<T, N>();
  X.value.p = factor.before.p.template cast<T>();
  const detail::CurveJet<T> amount = amountOf(factor, q_k);
  if (factor.turns) {
    const auto [A, A1, A2] = detail::turnAbout(factor.axis, amount);
    X.value.R.noalias() = R * A;
    X.first[k].R.noalias() = R * A1;
    X.second[kk].R.noalias() = R * A2;
  } else {
    const Vector along = R * factor.axis.template cast<T>();
    X.value.R = R;
    X.value.p += along * amount.value;
    X.first[k].p = along * amount.slope;
    X.second[kk].p = along * amount.curvature;
  }
}

template <class T, int N>
void Skeleton::motions(const Eigen::Matrix<T, N, 1>& q, RigidMotion<T, N>* out) const {
  out[0] = identityMotion<T, N>();
  for (std::size_t s = 1; s < segments_.size(); ++s) {
    const SegmentMotion& motion = segmentMotions_[s];
    auto factor = motion.factors.begin();
    if (motion.parent == 0 && factor != motion.factors.end()) {
      applyFirstFactor<T, N>(out[s], *factor, q[factor->freeIndex]);
      ++factor;
    } else {
      out[s] = out[motion.parent];
    }
    for (; factor != motion.factors.end(); ++factor) {
      applyFactor<T, N>(out[s], *factor, q[factor->freeIndex]);
    }
  }
}

namespace detail {

/// tr(A P Bᵀ) of 4×4 derivatives of placements, P the second moments of a segment.
template <class T>
T momentProduct(const Segment& segment, const Placement<T>& a, const Placement<T>& b) {
  const Eigen::Matrix<T, 3, 3> S = segment.secondMoment.template cast<T>();
  const Eigen::Matrix<T, 3, 1> m = segment.massMoment.template cast<T>();
  T sum = (a.R * S).cwiseProduct(b.R).sum();
  sum += (a.R * m).dot(b.p) + (b.R * m).dot(a.p);
  sum += T(segment.mass) * a.p.dot(b.p);
  return sum;
}

}  // namespace detail

template <int N>
InertiaJet<N> Skeleton::inertia(const Eigen::Matrix<double, N, 1>& q,
                                const RigidMotion<double, N>* moved) const {
  const auto at = [](int i, int j) { return static_cast<std::size_t>(pairIndex(i, j)); };
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  InertiaJet<N> jet;
  jet.massMatrix.setZero();
  jet.potential = 0;
  jet.dV.setZero();
  jet.d2V.setZero();
  for (auto& D : jet.dM) D.setZero();
  for (auto& D : jet.d2M) D.setZero();

  // gravity: V = −g·(R Σmr + p Σm), linear in the placement
  for (std::size_t s = 1; s < segments_.size(); ++s) {
    const Segment& segment = segments_[s];
    const auto energyOf = [&](const Placement<double>& X) {
      return -gravity_.dot(X.R * segment.massMoment + X.p * segment.mass);
    };
    jet.potential += energyOf(moved[s].value);
    for (int i = 0; i < N; ++i) {
      jet.dV[i] += energyOf(moved[s].first[index(i)]);
      for (int j = 0; j <= i; ++j) jet.d2V(i, j) += energyOf(moved[s].second[at(i, j)]);
    }
  }
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < i; ++j) jet.d2V(j, i) = jet.d2V(i, j);
  }

  if (constantInertia_) {
    jet.massMatrix.setConstant(constantMass_);
    return jet;
  }

  // mass matrix: first and second derivatives need second and third derivatives of the placements,
  // the third through the scalar type
  if (segments_.size() > maxFixedSegments) {
    throw std::logic_error("so many segments are evaluated as a tree");
  }
  using Ad = info::Dual<N>;
  Eigen::Matrix<Ad, N, 1> qAd;
  for (int i = 0; i < N; ++i) qAd[i] = Ad(q[i], N, i);
  std::array<RigidMotion<Ad, N>, maxFixedSegments> movedAd;
  motions<Ad, N>(qAd, movedAd.data());
  for (std::size_t s = 1; s < segments_.size(); ++s) {
    const auto& X = movedAd[s];
    for (int k = 0; k < N; ++k) {
      for (int l = 0; l <= k; ++l) {
        jet.massMatrix(k, l) +=
            detail::momentProduct(segments_[s], moved[s].first[index(k)], moved[s].first[index(l)]);
        for (int j = 0; j < N; ++j) {
          const Ad dM = detail::momentProduct(segments_[s], X.second[at(k, j)], X.first[index(l)]) +
                        detail::momentProduct(segments_[s], X.first[index(k)], X.second[at(l, j)]);
          jet.dM[index(j)](k, l) += dM.value();
          for (int i = 0; i <= j; ++i) jet.d2M[at(i, j)](k, l) += dM.derivatives()[i];
        }
      }
    }
  }
  for (int k = 0; k < N; ++k) {
    for (int l = 0; l < k; ++l) {
      jet.massMatrix(l, k) = jet.massMatrix(k, l);
      for (auto& D : jet.dM) D(l, k) = D(k, l);
      for (auto& D : jet.d2M) D(l, k) = D(k, l);
    }
  }
  return jet;
}

}  // namespace bio
