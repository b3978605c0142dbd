#pragma once

#include <limits>
#include <numbers>

/// Numbers that many tests use.
namespace support {

inline constexpr double degree = std::numbers::pi / 180;  ///< [rad]
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace support
