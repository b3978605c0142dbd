#pragma once

#include <algorithm>
#include <cmath>

namespace bio::detail {

// Positions x, y, z, a, r and their slopes.
inline constexpr int numPositions = 5;
struct JacobiMotion {
  double position[numPositions];
  double slope[numPositions];
};

// The difference of two motions, positions relative to a size, large numbers relative to
// themselves.
inline double difference(const JacobiMotion& a, const JacobiMotion& b, double perSize) {
  double worst = 0;
  for (int i = 0; i < numPositions; ++i) {
    const bool isPlain = i == 3;  // a; the others are lengths
    const double p = std::abs(a.position[i] - b.position[i]) * (isPlain ? 1 : perSize);
    const double v = std::abs(a.slope[i] - b.slope[i]) * (isPlain ? 1 / perSize : 1);
    const double large = i < 3 ? 1 : 1 + std::abs(b.slope[i]) * (isPlain ? 1 / perSize : 1);
    worst = std::max(worst, std::max(p, v / large));
  }
  return worst;
}

// One step by a rule whose error is even in the substep: rows of Neville's scheme until two
// neighbours agree. `row(k)` is the rule with k + 1 times its fewest substeps.
inline constexpr int maxRows = 10;
struct NevilleFactors {
  double factor[maxRows][maxRows] = {};
  constexpr NevilleFactors() {
    for (int k = 0; k < maxRows; ++k) {
      for (int j = 0; j < k; ++j) {
        const double ratio = static_cast<double>(k + 1) / (k - j);
        factor[k][j] = 1 / (ratio * ratio - 1);
      }
    }
  }
};
inline constexpr NevilleFactors neville;

template <class Row>
bool extrapolate(const Row& row, double perSize, double tolerance, JacobiMotion& result) {
  JacobiMotion table[maxRows];  // the last row, from its start to its end
  for (int k = 0; k < maxRows; ++k) {
    JacobiMotion left = row(k);
    for (int j = 0; j < k; ++j) {
      const double factor = neville.factor[k][j];
      for (int i = 0; i < numPositions; ++i) {
        const double position = left.position[i], slope = left.slope[i];
        left.position[i] += (position - table[j].position[i]) * factor;
        left.slope[i] += (slope - table[j].slope[i]) * factor;
        table[j].position[i] = position;
        table[j].slope[i] = slope;
      }
    }
    if (k > 0 && difference(left, table[k - 1], perSize) <= tolerance) {
      result = left;
      return true;
    }
    table[k] = left;
  }
  return false;
}

}  // namespace bio::detail
