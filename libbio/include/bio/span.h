#pragma once

#include <Eigen/Dense>

namespace bio {

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;

/// Length of the part of a path between two points P and Q, and how it follows them; all vectors in
/// one frame C. For an unsupported span L = |Q − P|; for a wrapped one L is the geodesic length,
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

}  // namespace bio
