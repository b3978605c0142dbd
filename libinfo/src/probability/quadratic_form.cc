#include "info/probability/quadratic_form.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace info {

using Eigen::ArrayXd;

double tailOfSquares(const Eigen::VectorXd& variances, double q) {
  if (variances.size() == 0 || !variances.allFinite() || variances.minCoeff() < 0 ||
      !(variances.maxCoeff() > 0) || std::isnan(q))
    throw std::invalid_argument(
        "tail of squares: variances must be finite and ≥ 0, at least one of them > 0");
  if (!(q > 0)) return 1;
  if (std::isinf(q)) return 0;
  // in units of the largest, so that s lies below ½
  const double unit = variances.maxCoeff();
  const ArrayXd v = variances.array() / unit;
  const double x = q / unit, mean = v.sum();
  const auto slope = [&](double s) { return (v / (1 - 2 * s * v)).sum(); };
  // K' rises from 0 at −∞ to ∞ at ½; K'(s) ≥ 1/(1 − 2s), and ≤ n/(−2s) below 0
  double low = -0.5 * static_cast<double>(v.size()) / x - 1, high = 0.5;
  for (int i = 0; i < 200 && high - low > 1e-15 * (1 + std::abs(low)); ++i) {
    const double middle = (low + high) / 2;
    (slope(middle) < x ? low : high) = middle;
  }
  const double s = (low + high) / 2;
  const auto normalTail = [](double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); };
  if (std::abs(x - mean) < 1e-4 * mean) {  // the limit of s → 0
    const double second = 2 * v.square().sum(), third = 8 * v.cube().sum();
    return normalTail((x - mean) / std::sqrt(second)) -
           third / (6 * std::pow(second, 1.5)) / std::sqrt(2 * std::numbers::pi);
  }
  const double K = -0.5 * (1 - 2 * s * v).log().sum();
  const double w = std::copysign(std::sqrt(std::max(0.0, 2 * (s * x - K))), s);
  const double u = s * std::sqrt(2 * (v / (1 - 2 * s * v)).square().sum());
  return normalTail(w + std::log(u / w) / w);
}

}  // namespace info
