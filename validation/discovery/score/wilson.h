#pragma once

namespace hidden {

/// Bounds of a share.
struct Interval {
  double low, high;
};

/// Wilson's 95 % interval of a proportion, k of n, without continuity correction (Wilson 1927):
///     (k + z²/2 ± z·√(k(n − k)/n + z²/4))/(n + z²),   z = 1.959964
/// 0 to 1 for n = 0. @throws std::invalid_argument unless 0 ≤ k ≤ n
Interval wilson(int k, int n);

}  // namespace hidden
