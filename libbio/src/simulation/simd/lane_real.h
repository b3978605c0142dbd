#pragma once

namespace bio::lanes {

/// Simulations that are advanced together, one per lane.
inline constexpr int width = 4;

/// Its alignment is said because GCC takes another one where the instruction set lacks such
/// vectors.
using Real [[gnu::vector_size(width * sizeof(double)), gnu::aligned(width * sizeof(double))]] =
    double;
/// All bits of a lane set: yes.
using Mask [[gnu::aligned(width * sizeof(double))]] = decltype(Real{} < Real{});
/// Number type of a list, as a template's argument: a vector type would lose its alignment
/// there.
struct Lanes {
  using Number = Real;
};
struct Single {
  using Number = double;
};
static_assert(alignof(Real) == sizeof(Real) && alignof(Mask) == sizeof(Mask));

}  // namespace bio::lanes
