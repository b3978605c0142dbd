#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "bio/skeleton/rigid_motion.h"

namespace bio {

/// Length of the part of a path between two points P and Q, with its gradient; all vectors in one
/// frame C. For an unsupported span L = |Q − P|; for a wrapped one L is the geodesic length,
/// stationary in the contact points, so that the gradient consists of the unit end tangents.
template <class T>
struct Span {
  T length;       ///< L [m]
  Vec3<T> dL_dP;  ///< ∂L/∂P = −(unit tangent at P, towards Q)
  Vec3<T> dL_dQ;  ///< ∂L/∂Q = +(unit tangent at Q, away from P)
  bool touches;   ///< false: a straight line
};

/// Second derivatives of a span's length [1/m].
template <class T>
struct SpanHessian {
  Mat3<T> d2L_dPdP;
  Mat3<T> d2L_dPdQ;  ///< rows P, columns Q
  Mat3<T> d2L_dQdQ;
};

/// A span with its second derivatives.
template <class T>
struct SpanToSecondOrder {
  Span<T> span;
  SpanHessian<T> hessian;
};

/// Contact points of a wrapped path; undefined for a straight span.
template <class T>
struct WrapContact {
  Vec3<T> p_CA;  ///< first contact, seen from P [m]
  Vec3<T> p_CB;  ///< last contact [m]
  T angle;       ///< wrapped angle β [rad] > 0
};

/// @throws std::domain_error: Thrown if an end of a wrapped path is not outside its surface.
///   Distances in m.
[[noreturn]] void throwEndInside(const char* center, double distanceP, double distanceQ,
                                 double radius);

/// The straight span from P to Q. C∞ for P ≠ Q.
template <class T>
Span<T> straightSpan(const Vec3<T>& p_CP, const Vec3<T>& p_CQ) {
  using std::sqrt;
  const Vec3<T> difference = p_CQ - p_CP;
  const T length = sqrt(T(difference.squaredNorm()));
  const Vec3<T> tangent = difference / length;
  return {length, Vec3<T>(-tangent), tangent, false};
}

/// straightSpan with its Hessian (1/L)(1 − t tᵀ), t the unit tangent.
template <class T>
SpanToSecondOrder<T> straightSpanToSecondOrder(const Vec3<T>& p_CP, const Vec3<T>& p_CQ) {
  SpanToSecondOrder<T> result{straightSpan(p_CP, p_CQ), {}};
  const Vec3<T>& t = result.span.dL_dQ;
  const Vec3<T> tPerLength = t / result.span.length;
  Mat3<T> across = -tPerLength * t.transpose();
  const T perLength = T(1.0) / result.span.length;
  for (int i = 0; i < 3; ++i) across(i, i) += perLength;
  result.hessian = {across, Mat3<T>(-across), across};
  return result;
}

}  // namespace bio
