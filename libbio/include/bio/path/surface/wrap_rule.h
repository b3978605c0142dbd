#pragma once

#include <string>
#include <vector>

#include "bio/path/surface/wrap_cylinder.h"
#include "bio/path/surface/wrap_sphere.h"

namespace bio {

/// The side of a wrap object on which a path must pass, in the object's frame.
enum class WrapQuadrant { all, plusX, minusX, plusY, minusY, plusZ, minusZ };

/// Reads "all", "x", "+x", "-x", … as in OpenSim's files, ignoring case.
/// @throws std::invalid_argument for any other word
WrapQuadrant wrapQuadrant(const std::string& word);

/// The unit vector towards the named side; zero for "all".
Vec3<double> directionOf(WrapQuadrant quadrant);

/// The side on which a path from P to Q goes round a cylinder about z.
///
/// A quadrant ±x or ±y selects, of the two ways round the cylinder, the one whose middle direction
/// between P and Q lies on that side, and "all" the shorter one. The side should be decided once,
/// in a reference posture, and kept up to the slip angle: then the length is C¹ while the ends move
/// and does not flip. OpenSim decides in each posture from the tangent points; both agree if a path
/// is near its quadrant.
/// @throws std::invalid_argument for a quadrant ±z, which names no side of a cylinder about z
Side cylinderSide(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// The angle Φ from P to Q round a cylinder about z, on a side of it [rad], 0 ≤ Φ < 2π.
double angleRound(Side side, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// The angle Φ from π to 2π beyond which a path has slipped off a cylinder: it is then straight (Φ
/// − 2π < 0) instead of wrapping the long way round. Default 2π: never.
struct SlipAngle {
  double cosine = 1;
  double sine = 0;
};

/// The slip angle that keeps a path continuous over all postures in which it occurs: in the middle
/// of the widest gap between its angles, so that the unavoidable jump of the length is as far from
/// them as possible.
/// @param decided Φ [rad] in the posture in which the side was decided and the path has not slipped
///   off
/// @param angles Φ [rad] of the postures, including `decided`, in any order
SlipAngle slipAngle(double decided, std::vector<double> angles);

/// Whether a path has slipped off a cylinder, i.e. Φ is above the slip angle.
bool hasSlippedOff(const SlipAngle& slip, Side side, const Vec3<double>& p_CP,
                   const Vec3<double>& p_CQ);

/// The arc of the great circle of a path from P to Q over a sphere: with "all" the shorter, else
/// the one whose middle lies on the named side.
Way sphereWay(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// Whether the segment from P to Q touches a cylinder of finite length about z, −length/2 …
/// length/2.
///
/// False where an end lies within the radius of the axis (such a path is left straight, as in
/// OpenSim), where the straight line passes on the given side, and where both contacts lie beyond
/// the ends.
bool cylinderTouches(double radius, double length, Side side, const Vec3<double>& p_CP,
                     const Vec3<double>& p_CQ);

}  // namespace bio
