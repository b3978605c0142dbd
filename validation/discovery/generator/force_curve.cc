#include "generator/force_curve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hidden {
namespace {

double gap(const std::vector<double>& x, std::size_t i) {
  return std::max(1e-7, x[i + 1] - x[i]);
}

// Third derivative of the cubic through points i … i+3: six times Newton's divided difference.
double thirdDerivative(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  double d[4] = {y[i], y[i + 1], y[i + 2], y[i + 3]};
  for (std::size_t order = 1; order <= 3; ++order) {
    for (std::size_t k = 0; k + order <= 3; ++k) {
      d[k] = (d[k + 1] - d[k]) / std::max(1e-7, x[i + k + order] - x[i + k]);
    }
  }
  return 6 * d[0];
}

}  // namespace

ForceCurve::ForceCurve(std::vector<double> x, std::vector<double> y)
    : x_(std::move(x)), y_(std::move(y)) {
  if (x_.size() < 4 || x_.size() != y_.size() || !std::is_sorted(x_.begin(), x_.end())) {
    throw std::invalid_argument("a force curve needs 4 or more points with rising x");
  }
  const std::size_t n = x_.size();
  const auto last = static_cast<Eigen::Index>(n) - 1;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(last + 1, last + 1);
  Eigen::VectorXd b(last + 1);
  const auto rise = [&](std::size_t i) { return (y_[i + 1] - y_[i]) / gap(x_, i); };
  // a cubic's third derivative from its end slopes: 6 (m_i + m_{i+1} − 2 rise)/h²
  A(0, 0) = A(0, 1) = 1;
  b[0] = 2 * rise(0) + gap(x_, 0) * gap(x_, 0) * thirdDerivative(x_, y_, 0) / 6;
  A(last, last) = A(last, last - 1) = 1;
  const double h = gap(x_, n - 2);
  b[last] = 2 * rise(n - 2) + h * h * thirdDerivative(x_, y_, n - 4) / 6;
  // equal second derivatives on both sides of an inner knot
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double before = gap(x_, i - 1), after = gap(x_, i);
    const double share = after / (before + after);
    A(k, k - 1) = share;
    A(k, k) = 2;
    A(k, k + 1) = 1 - share;
    b[k] = 3 * (share * rise(i - 1) + (1 - share) * rise(i));
  }
  slope_ = A.fullPivLu().solve(b);
}

double ForceCurve::at(double x) const {
  const std::size_t n = x_.size();
  if (std::isnan(x)) return x;
  if (x < x_[0]) return y_[0] + slope_[0] * (x - x_[0]);
  const auto end = static_cast<Eigen::Index>(n) - 1;
  if (x >= x_[n - 1]) return y_[n - 1] + slope_[end] * (x - x_[n - 1]);
  const auto above = std::upper_bound(x_.begin(), x_.end(), x);
  const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
  const auto k = static_cast<Eigen::Index>(i);
  const double h = gap(x_, i);
  const double t = (x - x_[i]) / h;
  // Hermite's form
  return y_[i] + t * t * (3 - 2 * t) * (y_[i + 1] - y_[i]) +
         h * t * (1 - t) * ((1 - t) * slope_[k] - t * slope_[k + 1]);
}

}  // namespace hidden
