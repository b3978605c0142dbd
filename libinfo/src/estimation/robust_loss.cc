#include "info/estimation/robust_loss.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace info {

LossValue evaluate(const RobustLoss& loss, double squared, Eigen::Index outputs) {
  switch (loss.kind) {
    case RobustLoss::Kind::gaussian:
      break;
    case RobustLoss::Kind::huber: {
      const double k = loss.threshold;
      if (!(k > 0)) throw std::invalid_argument(fmt::format("Huber threshold {} must be > 0", k));
      if (squared <= k * k) break;
      const double size = std::sqrt(squared);
      return {2 * k * size - k * k, k / size, -0.5 * k / (squared * size)};
    }
    case RobustLoss::Kind::student: {
      const double nu = loss.degreesOfFreedom;
      if (!(nu > 0)) {
        throw std::invalid_argument(fmt::format("Student degrees of freedom {} must be > 0", nu));
      }
      const double total = nu + static_cast<double>(outputs);
      const double below = nu + squared;
      return {total * std::log1p(squared / nu), total / below, -total / (below * below)};
    }
  }
  return {squared, 1, 0};
}

double varianceFactor(const RobustLoss& loss, const Eigen::VectorXd& whitened) {
  if (whitened.size() == 0)
    throw std::invalid_argument("variance factor: must have at least one residual");
  double square = 0, slope = 0;
  for (const double z : whitened) {
    const LossValue at = evaluate(loss, z * z);
    square += at.slope * at.slope * z * z;
    slope += at.slope + 2 * z * z * at.curvature;
  }
  const auto n = static_cast<double>(whitened.size());
  return (square / n) / ((slope / n) * (slope / n));
}

}  // namespace info
