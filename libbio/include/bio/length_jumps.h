#pragma once

#include <string>
#include <vector>

#include "bio/model.h"
#include "bio/skeleton.h"

namespace bio {

/// A value of a coordinate at which a muscle–tendon length jumps, and with it force and moment arm.
struct LengthJump {
  std::string muscle, coordinate;
  bool turns = true;         ///< the coordinate is an angle
  double value = 0;          ///< of the coordinate [rad] or [m]
  double size = 0;           ///< length just above it less length just below it [m]
  bool conditional = false;  ///< a conditional point comes or goes there, and every integrator ends
                             ///< a step on it; else the way round a wrap object changes, where
                             ///< motions of different integrators may part
};

/// Jumps of 1e-5 m or more of the enabled muscles that a skeleton's first coordinate moves, the
/// other free coordinates at their defaults, by muscle and value. Looked for in 720 steps. Muscles
/// without a path (UnsupportedWrap, ellipsoids that are not in wrapAsCylinder) are passed over.
/// @param from, to  of the coordinate, rising [rad] or [m]
std::vector<LengthJump> lengthJumps(const Model& model, const Skeleton& skeleton,
                                    const std::vector<std::string>& wrapAsCylinder, double from,
                                    double to);

/// The same of every coordinate that is neither locked nor follows another one, each by itself,
/// over its range and a share of it on either side. A range of more than 2π rad or 2 m is taken as
/// that much about the default, with nothing on either side.
std::vector<LengthJump> lengthJumps(const Model& model, double beyond = 0.3);

/// "the length of BRA jumps by 5.31 mm at elbow_flexion = 0 deg (a conditional point)"
std::string describe(const LengthJump& jump);

}  // namespace bio
