#pragma once

#include <algorithm>
#include <cmath>

namespace bio::detail {

// Positions x, y, z, a, r, then their slopes.
inline constexpr int numPositions = 5;
struct JacobiMotion {
  double number[2 * numPositions];
  double& position(int i) { return number[i]; }
  double position(int i) const { return number[i]; }
  double& slope(int i) { return number[numPositions + i]; }
  double slope(int i) const { return number[numPositions + i]; }
};

// Whether two motions agree, positions relative to a size, large numbers relative to themselves.
inline bool agree(const JacobiMotion& a, const JacobiMotion& b, double perSize, double tolerance) {
  bool all = true;
  for (int i = 0; i < numPositions; ++i) {
    const bool isPlain = i == 3;  // a; the others are lengths
    const double p = std::abs(a.position(i) - b.position(i)) * (isPlain ? 1 : perSize);
    const double v = std::abs(a.slope(i) - b.slope(i)) * (isPlain ? 1 / perSize : 1);
    const double large = i < 3 ? 1 : 1 + std::abs(b.slope(i)) * (isPlain ? 1 / perSize : 1);
    all = all && p <= tolerance && v <= tolerance * large;
  }
  return all;
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
      for (int i = 0; i < 2 * numPositions; ++i) {
        const double number = left.number[i];
        left.number[i] += (number - table[j].number[i]) * factor;
        table[j].number[i] = number;
      }
    }
    if (k > 0 && agree(left, table[k - 1], perSize, tolerance)) {
      result = left;
      return true;
    }
    table[k] = left;
  }
  return false;
}

}  // namespace bio::detail
