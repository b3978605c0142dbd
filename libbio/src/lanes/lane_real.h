#pragma once

namespace bio::lanes {

/// Simulations that are advanced together, one per lane.
inline constexpr int width = 4;

using Real [[gnu::vector_size(width * sizeof(double))]] = double;
/// All bits of a lane set: yes.
using Mask = decltype(Real{} < Real{});

}  // namespace bio::lanes
