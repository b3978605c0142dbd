#pragma once

// Not public.

#include <numbers>

namespace bio {

/// An angle beyond this is probably in degrees, though it should be in radians [rad].
inline constexpr double degreesBeyond = 4 * std::numbers::pi;

}  // namespace bio
