#include "score/wilson.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hidden {

Interval wilson(int k, int n) {
  if (!(0 <= k && k <= n)) throw std::invalid_argument("a proportion k of n needs 0 ≤ k ≤ n");
  if (n == 0) return {0, 1};
  constexpr double z = 1.959963984540054;
  const double K = k, N = n;
  const double middle = K + z * z / 2;
  const double width = z * std::sqrt(K * (N - K) / N + z * z / 4);
  return {std::max(0.0, (middle - width) / (N + z * z)),
          std::min(1.0, (middle + width) / (N + z * z))};
}

}  // namespace hidden
