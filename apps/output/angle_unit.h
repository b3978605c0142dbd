#pragma once

#include <numbers>
#include <string>

namespace app {

/// Angles are shown in degrees and computed in radians.
inline constexpr double degreesPerRadian = 180 / std::numbers::pi;  ///< in degrees
inline constexpr double radiansPerDegree = std::numbers::pi / 180;  ///< in radians

/// A unit in which people see a quantity.
struct ShownUnit {
  double factor;  ///< by which the value in SI units is multiplied
  std::string name;
};

}  // namespace app
