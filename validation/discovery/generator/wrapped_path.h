#pragma once

#include <Eigen/Core>

namespace hidden {

using Vec = Eigen::Vector3d;

/// Turns v by an angle [rad] about a unit axis (Rodrigues).
Vec turned(const Vec& v, const Vec& axis, double angle);

/// A cylinder fixed to the upper arm that a span may wrap.
struct Cylinder {
  Vec centre = Vec::Zero();  ///< [m]
  Vec x = Vec::UnitX();      ///< its own axes in the ground; z is the cylinder's axis
  Vec y = Vec::UnitY();
  Vec z = Vec::UnitZ();
  double radius = 0;      ///< [m]
  double halfLength = 0;  ///< [m]
  bool onPlusX = false;   ///< the path passes on its +x side; false: the shorter way round
};

/// A span's length and its end tangent at Q, pointing away from the path.
struct SpanLength {
  double length = 0;  ///< [m]
  Vec tangent = Vec::UnitX();
  bool wraps = false;
};

SpanLength straight(const Vec& P, const Vec& Q);

/// +1 where the path goes round counter-clockwise seen against the axis, −1 clockwise.
int sideOf(const Cylinder& cylinder, const Vec& P, const Vec& Q);

/// Shortest path from P to Q round the cylinder on the given side; straight where it does not
/// touch, where an end lies inside, where both contacts lie beyond the cylinder's ends, or where
/// the ends are more than three quarters of a turn apart on that side: such a path has slipped off.
///
/// Seen along the axis: tangents of lengths √(ρ² − r²) and an arc r·β,
/// β = Φ − arccos(r/ρ_P) − arccos(r/ρ_Q); unrolled the path is a straight line, so its height along
/// the axis grows evenly. The contact point gives the tangent.
SpanLength around(const Cylinder& cylinder, int side, const Vec& P, const Vec& Q);

}  // namespace hidden
