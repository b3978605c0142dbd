#include "info/design/trajectory_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info/information/optimality.h"
#include "info/information/symmetric_eigen.h"

namespace info {

using Eigen::MatrixXd;
using Eigen::VectorXd;

InformationCost informationCost(const InformationWeights& weights, const MatrixXd& information,
                                double repeatedTolerance) {
  bool any = false;
  for (const auto& [name, weight] : {std::pair{"E", weights.e},
                                     {"A", weights.a},
                                     {"D", weights.d},
                                     {"condition number", weights.condition}}) {
    if (!(weight >= 0 && std::isfinite(weight)))
      throw std::domain_error(
          fmt::format("weight of {} in the objective: {}, must be ≥ 0 and finite", name, weight));
    any = any || weight > 0;
  }
  InformationCost out{0, MatrixXd::Zero(information.rows(), information.cols())};
  if (!any) return out;
  const auto eigen = symmetricEigen(information);
  const VectorXd& lambda = eigen.values;
  if (!(lambda[0] > 1e-14 * lambda[lambda.size() - 1]))
    throw NoInformation(fmt::format(
        "the motion has no information about a combination of the parameters: the smallest "
        "eigenvalue of the information is {}, the largest {}, must be > 0; start from a motion in "
        "which every parameter affects the output, if need be by a small perturbation of this one",
        lambda[0], lambda[lambda.size() - 1]));
  const auto criterionOf = [&](Optimality which) {
    return criterion(which, information, repeatedTolerance);
  };
  if (weights.e > 0) {
    const Criterion c = criterionOf(Optimality::e);
    out.value += weights.e / c.value;
    out.dvalue_dI -= weights.e / (c.value * c.value) * c.dvalue_dI;
  }
  if (weights.a > 0) {
    const Criterion c = criterionOf(Optimality::a);
    out.value += weights.a * c.value;
    out.dvalue_dI += weights.a * c.dvalue_dI;
  }
  if (weights.d > 0) {
    const Criterion c = criterionOf(Optimality::d);
    out.value -= weights.d * c.value;
    out.dvalue_dI -= weights.d * c.dvalue_dI;
  }
  if (weights.condition > 0) {
    const Criterion c = criterionOf(Optimality::conditionNumber);
    out.value += weights.condition * c.value;
    out.dvalue_dI += weights.condition * c.dvalue_dI;
  }
  return out;
}

Barrier inputBarrier(double u, double lower, double upper, double weight) {
  constexpr double delta = 0.1;
  const double half = 0.5 * (upper - lower), x = (u - lower) / half - 1;
  const double s = 1 - x * x, ds_du = -2 * x / half;
  if (s > delta) return {-weight * std::log(s), -weight / s * ds_du};
  const double t = (s - 2 * delta) / delta;
  return {weight * (0.5 * (t * t - 1) - std::log(delta)), weight * t / delta * ds_du};
}

double limitCost(const InputLimits& limits, const VectorXd& u) {
  double sum = 0;
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i)
    sum += inputBarrier(u[i], limits.lower[i], limits.upper[i], limits.weight).value;
  return sum;
}

VectorXd limitSlope(const InputLimits& limits, const VectorXd& u) {
  VectorXd slope = VectorXd::Zero(u.size());
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i)
    slope[i] = inputBarrier(u[i], limits.lower[i], limits.upper[i], limits.weight).slope;
  return slope;
}

std::string describe(SearchEnd why) {
  switch (why) {
    case SearchEnd::slopeSmall:
      return "converged: the expected decrease of the cost is below the tolerance";
    case SearchEnd::noProgress:
      return "no step along the descent direction lowers the cost";
    case SearchEnd::iterationLimit:
      return "the iteration limit was reached while the cost was falling";
    case SearchEnd::stopped:
      return "stopped by the caller";
  }
  return "unknown";
}

SearchResult search(SearchProblem& problem, const SearchOptions& options) {
  const auto within = [](const char* name, double value, bool holds) {
    if (!holds) throw std::invalid_argument(fmt::format("{}: {} is out of range", name, value));
  };
  within("armijoSlope", options.armijoSlope, options.armijoSlope > 0 && options.armijoSlope < 1);
  within("armijoShrink", options.armijoShrink,
         options.armijoShrink > 0 && options.armijoShrink < 1);
  within("maxIterations", options.maxIterations, options.maxIterations >= 0);
  within("maxShrinks", options.maxShrinks, options.maxShrinks >= 1);
  within("slopeTolerance", options.slopeTolerance, options.slopeTolerance >= 0);
  within("relativeSlope", options.relativeSlope, options.relativeSlope >= 0);
  within("largestMove", options.largestMove, options.largestMove >= 0);

  SearchResult result;
  result.informationStart = problem.information();
  result.costs.push_back(problem.cost());
  const auto end = [&](SearchEnd why) {
    result.why = why;
    result.converged = why == SearchEnd::slopeSmall;
    result.information = problem.information();
    return result;
  };
  // J after the step taken along ζ, or nothing
  const auto lineSearch = [&](const SearchProblem::Direction& direction) {
    double step = 1;
    if (options.largestMove > 0 && direction.largestMove * step > options.largestMove)
      step = options.largestMove / direction.largestMove;
    for (int shrinks = 0; shrinks <= options.maxShrinks; ++shrinks) {
      ++result.trials;
      const double cost = problem.trial(step);
      if (cost <= problem.cost() + options.armijoSlope * step * direction.slope &&
          cost < problem.cost())
        return step;
      step *= options.armijoShrink;
    }
    return 0.0;
  };

  double tolerance = options.repeatedTolerance;
  while (true) {
    const SearchProblem::Direction direction = problem.findDirection(tolerance);
    result.slopes.push_back(direction.slope);
    const double enough =
        std::max(options.slopeTolerance, options.relativeSlope * std::abs(problem.cost()));
    if (!(-direction.slope > enough)) return end(SearchEnd::slopeSmall);
    if (result.iterations >= options.maxIterations) return end(SearchEnd::iterationLimit);
    const double step = lineSearch(direction);
    if (step == 0) {
      // at a kink of λ_min, once more with the eigenvalues that meet taken together
      if (tolerance >= options.stuckTolerance) return end(SearchEnd::noProgress);
      tolerance = options.stuckTolerance;
      result.slopes.pop_back();
      continue;
    }
    problem.accept();
    tolerance = options.repeatedTolerance;
    ++result.iterations;
    result.costs.push_back(problem.cost());
    result.steps.push_back(step);
    if (options.progress) {
      const auto eigen = symmetricEigen(problem.information());
      if (!options.progress(
              {result.iterations, problem.cost(), direction.slope, step, eigen.values}))
        return end(SearchEnd::stopped);
    }
  }
}

}  // namespace info
