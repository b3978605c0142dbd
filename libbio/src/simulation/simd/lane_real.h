#pragma once

#include <type_traits>

namespace bio::lanes {

/// Simulations that are advanced together, one per lane; as a template's argument, where a vector
/// type would lose its alignment. The alignment is said because GCC takes another one where the
/// instruction set lacks such vectors.
template <int n>
struct Lanes {
  static constexpr int width = n;
  using Number [[gnu::vector_size(n * sizeof(double)), gnu::aligned(n * sizeof(double))]] = double;
  /// All bits of a lane set: yes. The type that comparing two numbers gives.
  using Mask [[gnu::vector_size(n * sizeof(double)), gnu::aligned(n * sizeof(double))]] =
      std::conditional_t<sizeof(long) == sizeof(double), long, long long>;
};
struct Single {
  static constexpr int width = 1;
  using Number = double;
};

}  // namespace bio::lanes
