#pragma once

#include <string>
#include <vector>

#include "bio/wrap_cylinder.h"
#include "bio/wrap_sphere.h"

namespace bio {

/// The side of a wrap object that a path must pass, in the object's frame.
enum class WrapQuadrant { all, plusX, minusX, plusY, minusY, plusZ, minusZ };

/// Reads "all", "x", "+x", "-x", … as OpenSim's files spell them; case does not matter.
/// @throws std::invalid_argument for any other word
WrapQuadrant wrapQuadrant(const std::string& word);

/// The side on which a path from P to Q goes round a cylinder about z.
///
/// Each of the two ways round passes the directions between P's and Q's; the middle one decides:
/// with a quadrant ±x or ±y, the way whose middle lies on that side; with "all", the shorter way.
/// Decide once, in a reference posture, and keep the side, up to the slip angle: then the length is
/// C¹ while the ends move and does not flip. OpenSim decides anew in each posture, by where the
/// tangent points lie; the two agree wherever a path is near its quadrant.
/// @throws std::invalid_argument for a quadrant ±z, which names no side of a cylinder about z
Side cylinderSide(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// The angle Φ from P to Q round a cylinder about z, on a side of it [rad], 0 ≤ Φ < 2π.
double angleRound(Side side, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// The angle Φ from π to 2π beyond which a path round a cylinder has slipped off it: there it is
/// the path whose ends have come to Φ − 2π < 0, which is straight, and not the one that goes the
/// long way round. 2π by default: at no angle.
struct SlipAngle {
  double cosine = 1;
  double sine = 0;
};

/// The slip angle that keeps a path continuous over all postures in which it occurs: in the middle
/// of the widest gap between the angles that it takes, so that the jump, which a length that
/// depends on the posture alone must have, is as far from them as can be on either side.
/// @param decided  Φ [rad] where the side was decided, where the path has not slipped off
/// @param angles  Φ [rad] of the postures, `decided` among them, in any order
SlipAngle slipAngle(double decided, std::vector<double> angles);

/// Whether a path round a cylinder has slipped off it. Where it has not, Φ < π or between π and the
/// slip angle.
bool hasSlippedOff(const SlipAngle& slip, Side side, const Vec3<double>& p_CP,
                   const Vec3<double>& p_CQ);

/// Which arc of the great circle a path from P to Q takes over a sphere: with "all" the shorter,
/// else the one whose middle lies on the named side.
Way sphereWay(WrapQuadrant quadrant, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

/// Whether the segment from P to Q touches a cylinder of finite length about z, −length/2 …
/// length/2.
///
/// False where an end lies within the radius of the axis (such a path is left straight, as in
/// OpenSim), where the straight line passes on the given side, and where both contacts lie beyond
/// the ends.
bool cylinderTouches(double radius, double length, Side side, const Vec3<double>& p_CP,
                     const Vec3<double>& p_CQ);

/// As cylinderTouches, for a sphere.
bool sphereTouches(double radius, Way way, const Vec3<double>& p_CP, const Vec3<double>& p_CQ);

}  // namespace bio
