#pragma once

#include <cmath>
#include <numbers>

#include "bio/path/span.h"
#include "info/autodiff/dual.h"

namespace bio {

using info::plainValue;

/// Selects one of the two arcs of the great circle.
enum class Way { shorter, longer };

/// The path from P to Q round a sphere, in the plane of P, Q and the centre.
template <class T>
struct SphereGeometry {
  T distanceP, distanceQ;  ///< ρ, of the ends from the centre [m]
  T tangentP, tangentQ;    ///< √(ρ² − r²), from the ends to their contacts [m]
  Vec3<T> eP, eQ;          ///< unit tangents at P (towards the contact) and Q (away from it)
  Vec3<T> normal;          ///< unit normal of the plane, right-handed from P to Q
  T sinPhi, cosPhi;        ///< of the angle Φ from P to Q along the chosen arc
  T angle;                 ///< wrapped angle β ∈ (0, 2π) [rad]; undefined if !touches
  bool touches;            ///< β > 0
};

/// @throws std::domain_error if an end point is not outside the sphere
template <class T>
SphereGeometry<T> sphereGeometry(const T& radius, Way way, const Vec3<T>& p_CP,
                                 const Vec3<T>& p_CQ) {
  using std::atan2;
  using std::sqrt;
  const T rr = radius * radius;
  const T pp = p_CP.squaredNorm();
  const T qq = p_CQ.squaredNorm();
  if (!(plainValue(pp) > plainValue(rr)) || !(plainValue(qq) > plainValue(rr))) {
    throwEndInside("sphere's centre", std::sqrt(plainValue(pp)), std::sqrt(plainValue(qq)),
                   plainValue(radius));
  }
  SphereGeometry<T> g;
  g.distanceP = sqrt(pp);
  g.distanceQ = sqrt(qq);
  g.tangentP = sqrt(T(pp - rr));
  g.tangentQ = sqrt(T(qq - rr));
  const double sign = way == Way::shorter ? 1.0 : -1.0;
  const T perArea = T(1.0) / (g.distanceP * g.distanceQ);
  const Vec3<T> cross = p_CP.cross(p_CQ);
  const T area = sqrt(T(cross.squaredNorm()));
  g.normal = cross / T(area * T(sign));
  g.sinPhi = area * perArea * T(sign);
  g.cosPhi = p_CP.dot(p_CQ) * perArea;

  // Radial and turning directions at the ends, mixed by sin and cos of the tangent angle.
  const T perPP = T(1.0) / pp;
  const T perQQ = T(1.0) / qq;
  const Vec3<T> turnP = g.normal.cross(p_CP);
  const Vec3<T> turnQ = g.normal.cross(p_CQ);
  g.eP = (turnP * radius - p_CP * g.tangentP) * perPP;
  g.eQ = (turnQ * radius + p_CQ * g.tangentQ) * perQQ;
  const Vec3<T> turned = g.eP.cross(g.eQ);
  const T turn = turned.dot(g.normal);
  g.touches = way == Way::longer || plainValue(turn) > 0;
  if (g.touches) {
    const T principal = atan2(turn, T(g.eP.dot(g.eQ)));
    g.angle = plainValue(principal) < 0 ? T(principal + T(2 * std::numbers::pi)) : principal;
  } else {
    g.angle = T(0.0);
  }
  return g;
}

/// Path from P to Q over a sphere of radius r about the origin of frame C, along a great circle.
///
///     L = √(P² − r²) + r·β + √(Q² − r²),   β = Φ − arccos(r/P) − arccos(r/Q)
/// with P, Q the distances of the ends from the centre and Φ the angle between them (2π minus it on
/// the longer way). Straight where β ≤ 0. C¹ at lift-off, C∞ elsewhere; ∂L/∂r = β.
///
/// Domain: P, Q and the centre not on one line (NaN there, since all great circles are equally
/// short).
/// @param radius r [m] > 0
/// @throws std::domain_error if an end point is not outside the sphere
template <class T>
Span<T> wrapSphere(const T& radius, Way way, const Vec3<T>& p_CP, const Vec3<T>& p_CQ) {
  const SphereGeometry<T> g = sphereGeometry(radius, way, p_CP, p_CQ);
  if (!g.touches) return straightSpan(p_CP, p_CQ);
  const T length = g.tangentP + radius * g.angle + g.tangentQ;
  return {length, Vec3<T>(-g.eP), g.eQ, true};
}

/// wrapSphere with second derivatives in closed form: within the plane (1/a) m mᵀ as for a
/// cylinder; across it the plane itself turns, which also couples the ends.
template <class T>
SpanToSecondOrder<T> wrapSphereToSecondOrder(const T& radius, Way way, const Vec3<T>& p_CP,
                                             const Vec3<T>& p_CQ) {
  const SphereGeometry<T> g = sphereGeometry(radius, way, p_CP, p_CQ);
  if (!g.touches) return straightSpanToSecondOrder(p_CP, p_CQ);
  SpanToSecondOrder<T> result;
  const T length = g.tangentP + radius * g.angle + g.tangentQ;
  result.span = {length, Vec3<T>(-g.eP), g.eQ, true};
  const Vec3<T>& b = g.normal;
  const Vec3<T> mP = b.cross(g.eP);
  const Vec3<T> mQ = b.cross(g.eQ);
  const T perP = T(1.0) / g.distanceP;
  const T perQ = T(1.0) / g.distanceQ;
  const T turning = radius * g.cosPhi / g.sinPhi;
  const T acrossP = (g.tangentP + turning) * perP * perP;
  const T acrossQ = (g.tangentQ + turning) * perQ * perQ;
  const T coupling = -radius * perP * perQ / g.sinPhi;
  const Vec3<T> mPBent = mP / g.tangentP;
  const Vec3<T> mQBent = mQ / g.tangentQ;
  const Mat3<T> bb = b * b.transpose();
  result.hessian.d2L_dPdP = mPBent * mP.transpose() + bb * acrossP;
  result.hessian.d2L_dQdQ = mQBent * mQ.transpose() + bb * acrossQ;
  result.hessian.d2L_dPdQ = bb * coupling;
  return result;
}

/// Contact points and wrapped angle of wrapSphere; angle = 0 if the path is straight.
template <class T>
WrapContact<T> wrapSphereContact(const T& radius, Way way, const Vec3<T>& p_CP,
                                 const Vec3<T>& p_CQ) {
  const SphereGeometry<T> g = sphereGeometry(radius, way, p_CP, p_CQ);
  return {Vec3<T>(p_CP + g.eP * g.tangentP), Vec3<T>(p_CQ - g.eQ * g.tangentQ), g.angle};
}

}  // namespace bio
