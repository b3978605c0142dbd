#pragma once

// Values of a motion between its rows; not public.

#include <Eigen/Dense>
#include <algorithm>
#include <optional>
#include <vector>

namespace bio {

/// A value between two rows of a motion as a combination of values and speeds there: the cubic of
/// Hermite, as accurate as the integrators; and the slope of that cubic.
struct MotionWeights {
  Eigen::Index row = 0;
  double value0 = 0, value1 = 0, speed0 = 0, speed1 = 0;
  double slopeOfValue0 = 0, slopeOfValue1 = 0, slopeOfSpeed0 = 0, slopeOfSpeed1 = 0;

  template <class Values, class Speeds>
  auto value(const Values& q, const Speeds& qDot) const {
    return value0 * q(row) + value1 * q(row + 1) + speed0 * qDot(row) + speed1 * qDot(row + 1);
  }
  /// Values of whole rows, one column per quantity.
  template <class Values, class Speeds>
  Eigen::RowVectorXd rows(const Values& q, const Speeds& qDot) const {
    return value0 * q.row(row) + value1 * q.row(row + 1) + speed0 * qDot.row(row) +
           speed1 * qDot.row(row + 1);
  }
  /// Transposed: adds λ ∂value/∂(values, speeds).
  template <class Values, class Speeds>
  void addValue(double lambda, Values&& q, Speeds&& qDot) const {
    q(row) += lambda * value0;
    q(row + 1) += lambda * value1;
    qDot(row) += lambda * speed0;
    qDot(row + 1) += lambda * speed1;
  }
  template <class Values, class Speeds>
  auto slope(const Values& q, const Speeds& qDot) const {
    return slopeOfValue0 * q(row) + slopeOfValue1 * q(row + 1) + slopeOfSpeed0 * qDot(row) +
           slopeOfSpeed1 * qDot(row + 1);
  }
  /// Adds λ ∂slope/∂(values, speeds).
  template <class Values, class Speeds>
  void addSlope(double lambda, Values&& q, Speeds&& qDot) const {
    q(row) += lambda * slopeOfValue0;
    q(row + 1) += lambda * slopeOfValue1;
    qDot(row) += lambda * slopeOfSpeed0;
    qDot(row + 1) += lambda * slopeOfSpeed1;
  }
  template <class Values, class Speeds>
  Eigen::RowVectorXd slopeRows(const Values& q, const Speeds& qDot) const {
    return slopeOfValue0 * q.row(row) + slopeOfValue1 * q.row(row + 1) +
           slopeOfSpeed0 * qDot.row(row) + slopeOfSpeed1 * qDot.row(row + 1);
  }
};

/// Nothing where the motion has not come so far.
inline std::optional<MotionWeights> weightsAt(const std::vector<double>& time, double t) {
  constexpr double together = 1e-9;
  if (time.size() < 2 || t < time.front() - together || t > time.back() + together) return {};
  const auto behind = std::upper_bound(time.begin(), time.end(), t);
  const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      behind - time.begin() - 1, 0, static_cast<std::ptrdiff_t>(time.size()) - 2));
  const double h = time[k + 1] - time[k];
  const double s = (t - time[k]) / h;
  return MotionWeights{static_cast<Eigen::Index>(k), 1 + s * s * (2 * s - 3), s * s * (3 - 2 * s),
                       h * s * (1 - s) * (1 - s),    -h * s * s * (1 - s),    6 * s * (s - 1) / h,
                       6 * s * (1 - s) / h,          (1 - s) * (1 - 3 * s),   s * (3 * s - 2)};
}

}  // namespace bio
