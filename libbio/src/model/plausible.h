#pragma once

// Not public.

#include <numbers>

namespace bio {

/// An angle beyond this is probably in degrees, though it should be in radians [rad].
inline constexpr double degreesBeyond = 4 * std::numbers::pi;

/// A measured angle beyond this, and beyond its coordinate's range, is in degrees [rad].
inline constexpr double certainlyDegreesBeyond = 2 * std::numbers::pi;

/// Rows further apart, of a trial that lasts so long, are probably in milliseconds [s].
inline constexpr double millisecondsBeyond = 0.5, millisecondsFrom = 60;

/// A path that is shorter is none [m].
inline constexpr double shortestPath = 1e-6;

}  // namespace bio
