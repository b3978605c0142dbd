#include "bio/tables/interpolated_series.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bio {
namespace {

constexpr std::size_t largestFactor = 200, fewestRecorded = 8;
constexpr double straight = 0.1, rounding = 1e-9, gap = 1.5;

using Bends = std::vector<double>;  ///< |d_k| of consecutive samples

/// The |d_k| of each part without a gap.
std::vector<Bends> bendsOf(const Eigen::VectorXd& t, const Eigen::VectorXd& y) {
  std::vector<double> intervals;
  for (Eigen::Index k = 1; k < t.size(); ++k) intervals.push_back(t[k] - t[k - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  const double longest = gap * *middle;
  std::vector<Bends> parts(1);
  for (Eigen::Index k = 1; k + 1 < t.size(); ++k) {
    const double before = t[k] - t[k - 1], both = t[k + 1] - t[k - 1];
    if (before > longest || both - before > longest) {
      if (!parts.back().empty()) parts.emplace_back();
      continue;
    }
    parts.back().push_back(std::abs(y[k] - y[k - 1] - (y[k + 1] - y[k - 1]) * before / both));
  }
  return parts;
}

/// The place of the recorded samples among each n: where most of the bends are.
std::size_t phaseOf(const Bends& bends, std::size_t n) {
  std::vector<double> sums(n, 0.0);
  for (std::size_t k = 0; k < bends.size(); ++k) sums[k % n] += bends[k];
  return static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
}

/// How many samples are recorded if n is the factor; 0 if it is not.
std::size_t recordedIf(std::size_t n, const std::vector<Bends>& parts, double least) {
  Bends recorded;
  double between = 0;
  for (const Bends& bends : parts) {
    const std::size_t phase = phaseOf(bends, n);
    for (std::size_t k = 0; k < bends.size(); ++k) {
      if (k % n == phase) {
        recorded.push_back(bends[k]);
      } else {
        between = std::max(between, bends[k]);
      }
    }
  }
  const auto quarter = recorded.begin() + static_cast<std::ptrdiff_t>(3 * recorded.size() / 4);
  std::nth_element(recorded.begin(), quarter, recorded.end());
  return *quarter > least && between <= straight * *quarter ? recorded.size() : 0;
}

}  // namespace

int interpolationFactor(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  const auto samples = static_cast<std::size_t>(times.size());
  if (samples < 2 * fewestRecorded) return 1;
  const std::vector<Bends> parts = bendsOf(times, values);
  if (parts.front().empty()) return 1;
  const double least = rounding * values.cwiseAbs().maxCoeff();
  // the largest: what was interpolated by 10 looks as if by 2 and by 5, too
  for (std::size_t n = std::min(largestFactor, samples / 2); n > 1; --n) {
    const std::size_t recorded = recordedIf(n, parts, least);
    if (recorded > 0) return recorded < fewestRecorded ? 1 : static_cast<int>(n);
  }
  return 1;
}

}  // namespace bio
