#pragma once

#include "bio/path/surface/wrap_rule.h"

namespace bio {

/// A span over an ellipsoid as OpenSim takes it.
struct OpenSimSpan {
  bool touches = false;  ///< false: the straight line
  double length = 0;     ///< from P to Q [m]
};

/// How OpenSim's arc on the surface is measured.
enum class ArcLength {
  exact,  ///< along the plane section
  chords  ///< OpenSim's: as many chords as the distance of the tangent points has millimetres
};

/// OpenSim's rule for ellipsoids (WrapEllipsoid, method "hybrid"), restated to say where it differs
/// from a taut string. Nothing that is simulated uses it.
///
/// The path lies in the plane through P, Q and a point c on the ellipsoid, and is the section's
/// tangent – arc – tangent on the side of c. With r₁, r₂ where the chord cuts the ellipsoid and μ
/// the largest direction cosine of the chord with an axis:
/// - μ > 0.9: c is the point nearest to where the chord crosses that axis's plane, in this plane;
/// - μ ≤ 0.7073: from the middle of r₁r₂ in the mean direction from 298 points of it to the nearest
///   points of the ellipsoid;
/// - between: both, blended; and where the chord crosses the plane within 0.3 of r₁r₂ from its
///   ends, or beyond, μ counts as less.
/// A quadrant reflects c to its side; the fan's share of the reflected c is then brought halfway
/// back. Lengths are scaled so that the mean semi-axis is 1, which matters for the fan. Such a
/// section is a geodesic for spheres and by symmetry only; its length jumps where c does.
///
/// A chord that misses the ellipsoid, or an end inside it, leaves the path straight.
/// @param semiAxes [m] > 0
/// @param p_CP, p_CQ  in the ellipsoid's frame [m]
OpenSimSpan openSimEllipsoid(const Vec3<double>& semiAxes, WrapQuadrant quadrant,
                             const Vec3<double>& p_CP, const Vec3<double>& p_CQ, ArcLength measure);

}  // namespace bio
