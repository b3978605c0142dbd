#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// A value of a coordinate at which a muscle–tendon length jumps, or its moment arm alone.
struct LengthJump {
  std::string muscle, coordinate;
  bool turns = true;         ///< the coordinate is an angle
  double value = 0;          ///< of the coordinate [rad] or [m]
  double size = 0;           ///< length just above it less length just below it [m]
  double arm = 0;            ///< the same of the moment arm −∂ℓ/∂q [m/rad] or [1]
  bool conditional = false;  ///< a conditional point switches there, and every integrator ends
                             ///< a step at it; else the side of a wrap object changes, where
                             ///< motions of different integrators may diverge
};

/// Jumps of lengths by 1e-5 m or more, and of moment arms by 1e-3 m, of the enabled muscles that a
/// skeleton's first coordinate moves, the other free coordinates at their defaults, by muscle and
/// value. The range is searched in 720 steps. Moment arms that jump at an end of the coordinate's
/// range, where moving points are held, are not listed. Muscles without a computable path
/// (UnsupportedWrap, ellipsoids that are not in wrapAsCylinder) are skipped.
/// @param from, to  of the coordinate, rising [rad] or [m]
std::vector<LengthJump> lengthJumps(const Model& model, const Skeleton& skeleton,
                                    const std::vector<std::string>& wrapAsCylinder, double from,
                                    double to);

/// Jumps along every coordinate that is neither locked nor coupled, one at a time, over its range
/// and a margin on either side, at most 2π rad or 2 m in all. A range of more is reduced to that
/// width about the default, without margin.
std::vector<LengthJump> lengthJumps(const Model& model, double beyond = 0.3);

/// "the length of BRA jumps by 5.31 mm at elbow_flexion = 0 deg (a conditional point) and its moment
/// arm by 2.1 mm", or "the moment arm of BRA jumps by …" if the length does not.
std::string describe(const LengthJump& jump);

}  // namespace bio
