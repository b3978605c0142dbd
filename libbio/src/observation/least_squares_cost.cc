#include "bio/observation/least_squares_cost.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio {

MotionCost leastSquaresCost(const MusculoskeletalSystem& system, std::vector<ObservedSeries> series,
                            Eigen::VectorXd measured, Eigen::VectorXd sd) {
  const ObservedMotion observed(system, std::move(series));
  observed.requireAdjoint();
  if (measured.size() != observed.size() || sd.size() != observed.size()) {
    throw std::invalid_argument(
        fmt::format("least squares: {} measured values and {} standard deviations for {} samples, "
                    "must be as many",
                    measured.size(), sd.size(), observed.size()));
  }
  if (!measured.allFinite()) {
    throw std::invalid_argument("least squares: a measured value is not finite");
  }
  if (!((sd.array() > 0).all() && sd.allFinite())) {
    throw std::invalid_argument("least squares: every standard deviation must be > 0");
  }
  return [=](const Trajectory& motion) {
    const Eigen::VectorXd weighted = (observed.values(motion) - measured).cwiseQuotient(sd);
    CostOfMotion cost;
    cost.value = weighted.squaredNorm() / 2;
    if (std::isfinite(cost.value)) {
      observed.pullBack(motion, weighted.cwiseQuotient(sd), cost.q, cost.qDot);
    }
    return cost;
  };
}

}  // namespace bio
