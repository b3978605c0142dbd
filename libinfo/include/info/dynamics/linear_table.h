#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>

namespace info {

/// A place between two rows of a table, and the table's values there: straight between rows, and
/// those of the first or last row outside.
///     y = (1 − w) y_row + w y_{row+1}
struct LinearWeights {
  Eigen::Index row = 0;
  double behind = 0;  ///< w [1], 0 to 1
  template <class Values>
  double value(const Values& y) const {
    if (behind == 0) return y(row);
    return (1 - behind) * y(row) + behind * y(row + 1);
  }
  /// The interpolated row, one column per quantity.
  template <class Values>
  Eigen::RowVectorXd rows(const Values& y) const {
    if (behind == 0) return y.row(row);
    return (1 - behind) * y.row(row) + behind * y.row(row + 1);
  }
};

/// The place of t in rows at times [s] that rise, at least one.
/// @param times  std::vector<double> or Eigen::VectorXd
template <class Times>
LinearWeights linearAt(const Times& times, double t) {
  const auto n = static_cast<Eigen::Index>(times.size());
  if (n < 2) return {};
  const auto first = times.begin();
  const auto above = static_cast<Eigen::Index>(std::upper_bound(first, times.end(), t) - first);
  const Eigen::Index k = std::clamp<Eigen::Index>(above - 1, 0, n - 2);
  return {k, std::clamp((t - first[k]) / (first[k + 1] - first[k]), 0.0, 1.0)};
}

}  // namespace info
