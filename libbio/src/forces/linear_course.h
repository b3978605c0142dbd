#pragma once

// Not public.

#include <Eigen/Dense>
#include <algorithm>

namespace bio {

/// Straight between the values at times that rise, at least one; the first or last one outside.
/// @param times  std::vector<double> or Eigen::VectorXd [s]
template <class Times>
double linearAt(const Times& times, const Eigen::VectorXd& values, double t) {
  const auto above =
      static_cast<Eigen::Index>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (above == 0) return values[0];
  if (above == values.size()) return values[above - 1];
  const double before = times.begin()[above - 1], behind = times.begin()[above];
  const double w = (t - before) / (behind - before);
  return (1 - w) * values[above - 1] + w * values[above];
}

}  // namespace bio
