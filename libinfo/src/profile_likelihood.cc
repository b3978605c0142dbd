#include "info/profile_likelihood.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace info {

Profile profileLikelihood(const LeastSquares& problem, const Estimate& estimated,
                          Eigen::Index parameter, const std::vector<double>& values,
                          const EstimateOptions& options) {
  std::vector<Parameter> parameters = problem.parameters();
  if (parameter < 0 || parameter >= static_cast<Eigen::Index>(parameters.size()) ||
      estimated.parameters.size() != static_cast<Eigen::Index>(parameters.size()))
    throw std::invalid_argument(
        fmt::format("profile likelihood: there is no parameter {}", parameter));
  Parameter& held = parameters[static_cast<std::size_t>(parameter)];
  const Parameter free = held;
  for (double value : values)
    if (!(value >= free.lower && value <= free.upper && std::isfinite(value)))
      throw std::invalid_argument(
          fmt::format("profile likelihood: parameter {}: value {} must be within "
                      "its bounds {} … {}",
                      label(free), value, free.lower, free.upper));

  Profile profile;
  const double z = normalQuantile(options.confidence);
  profile.threshold = estimated.cost + 0.5 * z * z;
  profile.points.resize(values.size());
  // outwards from the estimate, each side from its nearest point on
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  const double centre = estimated.parameters[parameter];
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(values[a] - centre) < std::abs(values[b] - centre);
  });
  Eigen::VectorXd below = estimated.parameters, above = estimated.parameters;
  for (std::size_t i : order) {
    Eigen::VectorXd& start = values[i] < centre ? below : above;
    start[parameter] = held.lower = held.upper = held.start = values[i];
    const LeastSquares conditional(problem.predictor(), problem.measurements(), parameters);
    const Estimate best = estimate(conditional, start, options);
    profile.points[i] = {values[i], best.cost, best.parameters, best.converged};
    start = best.parameters;
  }
  return profile;
}

}  // namespace info
