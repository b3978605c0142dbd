#include "info/estimation/profile_likelihood.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace info {
namespace {

/// The least cost near `start`. Where the model has no value at `start` it is infinite; what has no
/// effect there stays as it is.
ProfilePoint pointFrom(const LeastSquares& conditional, const Eigen::VectorXd& start, double value,
                       const EstimateOptions& options) {
  try {
    const Estimate best = estimate(conditional, start, options);
    return {value, best.cost, best.parameters, best.converged};
  } catch (const std::domain_error&) {
    const LeastSquares::Linearised at = conditional.linearise(start);
    if (!std::isfinite(at.cost))
      return {value, std::numeric_limits<double>::infinity(), start, false};
    std::vector<Parameter> parameters = conditional.parameters();
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      if (!(at.information(j, j) > 0))
        parameters[k].lower = parameters[k].upper = parameters[k].start = start[j];
    }
    const Estimate best =
        estimate({conditional.predictor(), conditional.measurements(), parameters}, start, options);
    return {value, best.cost, best.parameters, best.converged};
  }
}

}  // namespace

Profile profileLikelihood(const LeastSquares& problem, const Estimate& estimated,
                          Eigen::Index parameter, const std::vector<double>& values,
                          const EstimateOptions& options) {
  std::vector<Parameter> parameters = problem.parameters();
  if (parameter < 0 || parameter >= static_cast<Eigen::Index>(parameters.size()) ||
      estimated.parameters.size() != static_cast<Eigen::Index>(parameters.size()))
    throw std::invalid_argument(fmt::format("profile likelihood: no parameter {}", parameter));
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
    profile.points[i] = pointFrom({problem.predictor(), problem.measurements(), parameters}, start,
                                  values[i], options);
    start = profile.points[i].parameters;
  }
  return profile;
}

ProfileInterval profileInterval(const LeastSquares& problem, const Estimate& estimated,
                                Eigen::Index parameter, double sd, const EstimateOptions& options) {
  if (!(sd > 0 && std::isfinite(sd)))
    throw std::invalid_argument(
        fmt::format("profile interval: standard deviation {} must be finite and > 0", sd));
  ProfileInterval result;
  result.profile = profileLikelihood(problem, estimated, parameter, {}, options);
  const double z = normalQuantile(options.confidence);
  const double centre = estimated.parameters[parameter];
  const Parameter& free = problem.parameters()[static_cast<std::size_t>(parameter)];

  // of one value: how many deviations of the likelihood it is away
  ProfilePoint from{centre, estimated.cost, estimated.parameters, true};
  const auto rootAt = [&](double value) {
    Estimate near = estimated;
    near.parameters = from.parameters;
    const ProfilePoint point =
        profileLikelihood(problem, near, parameter, {value}, options).points.front();
    result.profile.points.push_back(point);
    if (std::isfinite(point.cost)) from = point;
    return std::sqrt(2 * std::max(0.0, point.cost - estimated.cost));
  };
  const auto search = [&](double side, double bound, bool& atBound) {
    from = {centre, estimated.cost, estimated.parameters, true};
    double inside = centre, rootInside = 0;
    for (double steps = 1; steps <= 8; steps *= 2) {
      double outside = centre + side * steps * z * sd;
      const bool last = side * (outside - bound) >= 0;
      if (last) outside = bound;
      if (outside == inside) break;
      double rootOutside = rootAt(outside);
      if (rootOutside < z) {
        inside = outside;
        rootInside = rootOutside;
        if (!last) continue;
        atBound = true;
        return bound;
      }
      for (int i = 0; i < 12; ++i) {
        // where the model ends there is no slope to follow
        const double share =
            std::isfinite(rootOutside) ? (z - rootInside) / (rootOutside - rootInside) : 0.5;
        const double middle = inside + share * (outside - inside);
        if (std::abs(middle - inside) < 0.01 * sd || std::abs(middle - outside) < 0.01 * sd)
          return middle;
        const double root = rootAt(middle);
        (root < z ? inside : outside) = middle;
        (root < z ? rootInside : rootOutside) = root;
      }
      return 0.5 * (inside + outside);
    }
    if (inside == bound) {
      atBound = true;
      return bound;
    }
    return side * std::numeric_limits<double>::infinity();
  };
  result.lower = search(-1, free.lower, result.lowerAtBound);
  result.upper = search(1, free.upper, result.upperAtBound);
  std::sort(result.profile.points.begin(), result.profile.points.end(),
            [](const ProfilePoint& a, const ProfilePoint& b) { return a.value < b.value; });
  return result;
}

}  // namespace info
