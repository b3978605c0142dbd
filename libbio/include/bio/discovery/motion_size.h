#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/tables/trial.h"

namespace bio::discover {

/// How fast and how far a coordinate moves, as measured.
struct MotionSize {
  double speed = 0;   ///< root mean square [rad/s] or [m/s]
  double spread = 0;  ///< standard deviation of the position [rad] or [m]
};

/// Sizes of the measured motions of coordinates, over all trials: root mean squares of those of
/// each trial. The speed is that over the shortest of 1, 2, 4, … samples in which the coordinate
/// moves by a quarter of its spread (root mean square), so that noise of a twentieth of the spread
/// hardly adds to it. A coordinate that is not measured, or does not move, has none.
std::map<std::string, MotionSize> motionSizes(const std::vector<Trial>& trials,
                                              const std::vector<std::string>& coordinates);

}  // namespace bio::discover
