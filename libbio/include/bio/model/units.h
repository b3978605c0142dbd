#pragma once

#include <numbers>
#include <string>

/// Units in which people read and write; inside everything is in SI units and radians.
namespace bio {

inline constexpr double degreesPerRadian = 180 / std::numbers::pi;
inline constexpr double radiansPerDegree = std::numbers::pi / 180;

/// A unit in which people see a quantity.
struct ShownUnit {
  double factor;  ///< by which the value in SI units is multiplied
  std::string name;
};

/// The unit in which a coordinate's position is shown: degrees where it turns, millimetres where it
/// slides.
inline ShownUnit positionUnit(bool isRotation) {
  return isRotation ? ShownUnit{degreesPerRadian, "deg"} : ShownUnit{1e3, "mm"};
}

}  // namespace bio
