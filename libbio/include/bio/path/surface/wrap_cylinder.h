#pragma once

#include <cmath>
#include <numbers>

#include "bio/path/span.h"
#include "info/autodiff/dual.h"

namespace bio {

using info::plainValue;

/// Sense of rotation of a path about an axis, from its first point to its last, seen with the axis
/// pointing at the viewer.
enum class Side { counterclockwise = 1, clockwise = -1 };

/// The path from P to Q round a cylinder, projected along its axis: the terms of length, gradient
/// and Hessian.
template <class T>
struct CylinderGeometry {
  T tangentP, tangentQ;  ///< √(ρ² − r²), from the ends to their contacts [m]
  T eP[2], eQ[2];        ///< unit tangents at P (towards the contact) and Q (away from it)
  T angle;               ///< wrapped angle β ∈ (0, 2π) [rad]; undefined if !touches
  bool touches;          ///< β > 0
};

/// @throws std::domain_error if an end point is not outside the cylinder
template <class T>
CylinderGeometry<T> cylinderGeometry(const T& radius, Side side, const Vec3<T>& p_CP,
                                     const Vec3<T>& p_CQ) {
  using std::atan2;
  using std::sqrt;
  const double sigma = side == Side::counterclockwise ? 1.0 : -1.0;
  const T r = radius * T(sigma);  // signed: all turning below follows it
  const T rr = radius * radius;
  const T pp = p_CP.x() * p_CP.x() + p_CP.y() * p_CP.y();
  const T qq = p_CQ.x() * p_CQ.x() + p_CQ.y() * p_CQ.y();
  if (!(plainValue(pp) > plainValue(rr)) || !(plainValue(qq) > plainValue(rr))) {
    throwEndInside("cylinder's axis", std::sqrt(plainValue(pp)), std::sqrt(plainValue(qq)),
                   plainValue(radius));
  }
  CylinderGeometry<T> g;
  const T perPP = T(1.0) / pp;
  const T perQQ = T(1.0) / qq;
  g.tangentP = sqrt(T(pp - rr));
  g.tangentQ = sqrt(T(qq - rr));
  const T& a = g.tangentP;
  const T& b = g.tangentQ;

  // Unit tangents: the ends' radial and turning directions, mixed by sin and cos of the tangent
  // angle.
  g.eP[0] = -(a * p_CP.x() + r * p_CP.y()) * perPP;
  g.eP[1] = (r * p_CP.x() - a * p_CP.y()) * perPP;
  g.eQ[0] = (b * p_CQ.x() - r * p_CQ.y()) * perQQ;
  g.eQ[1] = (r * p_CQ.x() + b * p_CQ.y()) * perQQ;

  // Along the path the tangent turns by β, from eP to eQ. The angle between the ends distinguishes
  // β < 0 (no contact) from β > π.
  const T turn = (g.eP[0] * g.eQ[1] - g.eP[1] * g.eQ[0]) * T(sigma);
  const T along = g.eP[0] * g.eQ[0] + g.eP[1] * g.eQ[1];
  const bool halfTurn = sigma * (plainValue(p_CP.x()) * plainValue(p_CQ.y()) -
                                 plainValue(p_CP.y()) * plainValue(p_CQ.x())) <
                        0;  // ends more than π apart
  g.touches = halfTurn || plainValue(turn) > 0;
  if (g.touches) {
    const T principal = atan2(turn, along);
    g.angle = plainValue(principal) < 0 ? T(principal + T(2 * std::numbers::pi)) : principal;
  } else {
    g.angle = T(0.0);
  }
  return g;
}

/// Shortest path from P to Q on a given side of an infinite cylinder about the z-axis of frame C.
///
/// Unrolled, the path is a straight line: with s its length seen along z and P, Q the distances of
/// the ends from the axis,
///     s = √(P² − r²) + r·β + √(Q² − r²),   L = √(s² + Δz²)
///     β = Φ − arccos(r/P) − arccos(r/Q),   Φ ∈ [0, 2π) the angle from P to Q on the given side.
/// L is stationary in the contact points, so their motion does not enter the gradient. The path is
/// straight where β ≤ 0. L is C¹ at lift-off (β = 0), C∞ elsewhere, and jumps where P and Q lie on
/// one ray from the axis (Φ = 0). β may exceed π. ∂L/∂r = β·s/L.
///
/// Appendix A of Wilson's thesis, which decides contact by (A.1) only; that also holds if the axis
/// lies beyond the segment, hence the condition β > 0 here.
///
/// @param radius r [m] > 0
/// @throws std::domain_error if an end point is not outside the cylinder
template <class T>
Span<T> wrapCylinder(const T& radius, Side side, const Vec3<T>& p_CP, const Vec3<T>& p_CQ) {
  using std::sqrt;
  const CylinderGeometry<T> g = cylinderGeometry(radius, side, p_CP, p_CQ);
  if (!g.touches) return straightSpan(p_CP, p_CQ);
  const T s = g.tangentP + radius * g.angle + g.tangentQ;
  const T h = p_CQ.z() - p_CP.z();
  const T length = sqrt(T(s * s + h * h));
  const T around = s / length;
  const T up = h / length;
  const Vec3<T> dL_dP(T(-around * g.eP[0]), T(-around * g.eP[1]), T(-up));
  const Vec3<T> dL_dQ(T(around * g.eQ[0]), T(around * g.eQ[1]), up);
  return {length, dL_dP, dL_dQ, true};
}

/// wrapCylinder with the terms of its second derivatives: the Hessian with respect to both ends is
/// the sum of three dyads,
///     bendP nP nPᵀ + bendQ nQ nQᵀ + perLength m mᵀ,   m = (mP, mQ)
/// because s is the sum of a term of P and one of Q, whose Hessians are (1/a) n nᵀ with a the
/// tangent length and n across the tangent, and L = √(s² + Δz²) has one curvature. Undefined if
/// !span.touches.
template <class T>
struct CylinderDyads {
  Span<T> span;
  Vec3<T> nP, nQ;  ///< across the tangents, in the plane
  Vec3<T> mP, mQ;
  T bendP, bendQ, perLength;  ///< [1/m]
  T angle;                    ///< β [rad]
};

template <class T>
CylinderDyads<T> wrapCylinderDyads(const T& radius, Side side, const Vec3<T>& p_CP,
                                   const Vec3<T>& p_CQ) {
  using std::sqrt;
  const CylinderGeometry<T> g = cylinderGeometry(radius, side, p_CP, p_CQ);
  CylinderDyads<T> result;
  result.span.touches = g.touches;
  if (!g.touches) return result;
  const T s = g.tangentP + radius * g.angle + g.tangentQ;
  const T h = p_CQ.z() - p_CP.z();
  const T length = sqrt(T(s * s + h * h));
  result.perLength = T(1.0) / length;
  const T around = s * result.perLength;
  const T up = h * result.perLength;
  result.span.length = length;
  result.span.dL_dP = Vec3<T>(T(-around * g.eP[0]), T(-around * g.eP[1]), T(-up));
  result.span.dL_dQ = Vec3<T>(T(around * g.eQ[0]), T(around * g.eQ[1]), up);
  result.nP = Vec3<T>(T(-g.eP[1]), g.eP[0], T(0.0));
  result.nQ = Vec3<T>(T(-g.eQ[1]), g.eQ[0], T(0.0));
  result.mP = Vec3<T>(T(-up * g.eP[0]), T(-up * g.eP[1]), around);
  result.mQ = Vec3<T>(T(up * g.eQ[0]), T(up * g.eQ[1]), T(-around));
  result.bendP = around / g.tangentP;
  result.bendQ = around / g.tangentQ;
  result.angle = g.angle;
  return result;
}

/// wrapCylinder with second derivatives. At lift-off the Hessian jumps.
template <class T>
SpanToSecondOrder<T> wrapCylinderToSecondOrder(const T& radius, Side side, const Vec3<T>& p_CP,
                                               const Vec3<T>& p_CQ) {
  const CylinderDyads<T> d = wrapCylinderDyads(radius, side, p_CP, p_CQ);
  if (!d.span.touches) return straightSpanToSecondOrder(p_CP, p_CQ);
  SpanToSecondOrder<T> result;
  result.span = d.span;
  const Vec3<T> nPBent = d.nP * d.bendP;
  const Vec3<T> nQBent = d.nQ * d.bendQ;
  const Vec3<T> mPPerLength = d.mP * d.perLength;
  const Vec3<T> mQPerLength = d.mQ * d.perLength;
  result.hessian.d2L_dPdP = nPBent * d.nP.transpose() + mPPerLength * d.mP.transpose();
  result.hessian.d2L_dPdQ = mPPerLength * d.mQ.transpose();
  result.hessian.d2L_dQdQ = nQBent * d.nQ.transpose() + mQPerLength * d.mQ.transpose();
  return result;
}

/// Contact points and wrapped angle of wrapCylinder; angle = 0 if the path is straight.
template <class T>
WrapContact<T> wrapCylinderContact(const T& radius, Side side, const Vec3<T>& p_CP,
                                   const Vec3<T>& p_CQ) {
  const CylinderGeometry<T> g = cylinderGeometry(radius, side, p_CP, p_CQ);
  const T s = g.tangentP + radius * g.angle + g.tangentQ;
  const T rise = (p_CQ.z() - p_CP.z()) / s;  // height gained per length seen along z
  const Vec3<T> p_CA(T(p_CP.x() + g.tangentP * g.eP[0]), T(p_CP.y() + g.tangentP * g.eP[1]),
                     T(p_CP.z() + g.tangentP * rise));
  const Vec3<T> p_CB(T(p_CQ.x() - g.tangentQ * g.eQ[0]), T(p_CQ.y() - g.tangentQ * g.eQ[1]),
                     T(p_CQ.z() - g.tangentQ * rise));
  return {p_CA, p_CB, g.angle};
}

}  // namespace bio
