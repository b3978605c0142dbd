#pragma once

// Not public.

#include <algorithm>
#include <numbers>

#include "bio/model/model.h"

namespace bio {

/// An angle beyond this is probably in degrees, though it should be in radians [rad].
inline constexpr double degreesBeyond = 4 * std::numbers::pi;

/// A measured angle beyond this, and beyond its coordinate's range, is in degrees [rad].
inline constexpr double certainlyDegreesBeyond = 2 * std::numbers::pi;

/// Rows further apart, of a trial that lasts so long, are probably in milliseconds [s].
inline constexpr double millisecondsBeyond = 0.5, millisecondsFrom = 60;

/// A path that is shorter is none [m].
inline constexpr double shortestPath = 1e-6;

/// A wrap object beyond this is probably in millimetres [m].
inline constexpr double largestWrap = 0.5;

/// Its largest radius or semi-axis [m].
inline double sizeOf(const WrapObject& wrap) {
  return std::max({wrap.radius, wrap.outerRadius, wrap.semiAxes.maxCoeff()});
}

}  // namespace bio
