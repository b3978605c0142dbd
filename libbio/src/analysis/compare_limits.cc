#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "analysis/compare_runs.h"
#include "bio/model/units.h"

namespace bio {
namespace compare {

/// Why a step does not count as stable; empty if it does.
std::string Runs::fault(Integrator integrator, double step) const {
  const Trajectory motion = run(integrator, step);
  if (motion.outcome != Outcome::completed) return motion.why;
  const double rms = sd(*system_, motion, reference_->motion).rms;
  if (rms < options_->usefulError) return "";
  return fmt::format("reaches the end with an RMS error of {:.3g} deg", rms / radiansPerDegree);
}

StepLimit Runs::limit(Integrator integrator) const {
  constexpr double smallest = 1e-6;  // [s]; beyond it a run takes minutes
  StepLimit limit;
  limit.integrator = integrator;
  limit.stable = limit.failing = std::numeric_limits<double>::quiet_NaN();
  const double largest = options_->duration / 4;
  double step = std::min(1e-3, largest);
  std::string why = fault(integrator, step);
  if (why.empty()) {
    while (why.empty()) {
      limit.stable = step;
      if (step >= largest) return limit;
      step = std::min(2 * step, largest);
      why = fault(integrator, step);
    }
    limit.failing = step;
    limit.why = why;
  } else {
    while (!why.empty()) {
      limit.failing = step;
      limit.why = why;
      step /= 2;
      if (step < smallest) return limit;
      why = fault(integrator, step);
    }
    limit.stable = step;
  }
  while (limit.failing / limit.stable > options_->stepResolution) {
    step = std::sqrt(limit.failing * limit.stable);
    why = fault(integrator, step);
    if (why.empty()) {
      limit.stable = step;
    } else {
      limit.failing = step;
      limit.why = why;
    }
  }
  return limit;
}

ObservedOrder Runs::order(Integrator integrator) const {
  std::vector<double> steps;
  std::vector<double> errors;
  for (const double step : orderSteps(integrator)) {
    if (step > options_->duration) continue;
    const Trajectory motion = run(integrator, step);
    if (motion.outcome != Outcome::completed) continue;
    steps.push_back(step);
    errors.push_back(sd(*system_, motion, reference_->motion).rms);
  }
  ObservedOrder order = fitOrder(steps, errors, reference_->floor());
  order.integrator = integrator;
  return order;
}

}  // namespace compare

ObservedOrder fitOrder(const std::vector<double>& steps, const std::vector<double>& errors,
                       double floor) {
  if (steps.size() != errors.size()) {
    throw std::invalid_argument(
        fmt::format("order: {} steps and {} errors", steps.size(), errors.size()));
  }
  ObservedOrder result;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(steps[i] > 0)) {
      throw std::invalid_argument(fmt::format("order: step = {} s, must be > 0", steps[i]));
    }
    if (!(errors[i] > 10 * floor) || !(errors[i] > 0) || !std::isfinite(errors[i])) continue;
    result.steps.push_back(steps[i]);
    result.errors.push_back(errors[i]);
  }
  const auto n = static_cast<double>(result.steps.size());
  result.order = std::numeric_limits<double>::quiet_NaN();
  if (n < 3) return result;
  double x = 0, y = 0;
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    x += std::log(result.steps[i]) / n;
    y += std::log(result.errors[i]) / n;
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const double dx = std::log(result.steps[i]) - x;
    xx += dx * dx;
    xy += dx * (std::log(result.errors[i]) - y);
  }
  if (xx > 0) result.order = xy / xx;
  return result;
}

std::vector<double> orderSteps(Integrator integrator) {
  switch (integrator) {
    case Integrator::variational:
      return {0.00125, 0.0025, 0.005, 0.01, 0.02};
    case Integrator::variationalLeft:
      return {0.000625, 0.00125, 0.0025, 0.005};
    case Integrator::rungeKutta4:
      return {0.0001,
              0.0001111111111111111,
              0.000125,
              0.0001428571428571429,
              0.0001666666666666667,
              0.0002,
              0.00025};
    case Integrator::variationalAdaptive:
    case Integrator::cvode:
      break;
  }
  return {};
}

}  // namespace bio
