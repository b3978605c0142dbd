#pragma once

#include <numbers>

namespace app {

/// Angles are shown in degrees and computed in radians.
inline constexpr double degreesPerRadian = 180 / std::numbers::pi;  ///< in degrees
inline constexpr double radiansPerDegree = std::numbers::pi / 180;  ///< in radians

}  // namespace app
