#pragma once

#include <numbers>

namespace app {

/// People read degrees, everything inside computes in radians.
inline constexpr double radian = 180 / std::numbers::pi;  ///< in degrees
inline constexpr double degree = std::numbers::pi / 180;  ///< in radians

}  // namespace app
