#pragma once

// Not public.

#include <optional>
#include <vector>

#include "simulation/motion_weights.h"

namespace bio::discover {

/// Where the coordinate is looked at: before the start it goes on with its first speed.
inline std::optional<MotionWeights> lookAt(const std::vector<double>& time, double t) {
  if (time.size() >= 2 && t < time.front()) {
    return MotionWeights{0, 1, 0, t - time.front(), 0, 0, 0, 1, 0};
  }
  return weightsAt(time, t);
}

}  // namespace bio::discover
