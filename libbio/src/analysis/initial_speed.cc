#include "analysis/initial_speed.h"

#include <cmath>

namespace bio {

double initialSpeedShown(const std::vector<double>& times, const Eigen::VectorXd& measured,
                         double slowest) {
  constexpr double span = 0.25, standardErrors = 4;
  Eigen::Index n = 0;
  while (n < measured.size() && times[static_cast<std::size_t>(n)] - times[0] <= span) ++n;
  if (n < 8) return 0;
  // q ≈ c0 + c1·s + c2·s², s from 0 to 1 so that the normal equations are well conditioned
  const double width = times[static_cast<std::size_t>(n - 1)] - times[0];
  Eigen::MatrixX3d powers(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double s = (times[static_cast<std::size_t>(k)] - times[0]) / width;
    powers.row(k) << 1, s, s * s;
  }
  const Eigen::Matrix3d inverse = (powers.transpose() * powers).inverse();
  const Eigen::VectorXd values = measured.head(n);
  const Eigen::Vector3d c = inverse * (powers.transpose() * values);
  const double variance = (values - powers * c).squaredNorm() / static_cast<double>(n - 3);
  const double speed = c[1] / width, error = std::sqrt(variance * inverse(1, 1)) / width;
  return std::abs(speed) > slowest && std::abs(speed) > standardErrors * error ? speed : 0;
}

}  // namespace bio
