#include "calibration/other_minima.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bio {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Ends of searches that are looked at: nats above the lowest.
constexpr double worthRefining = 20;

/// Within three standard deviations of an estimate, in each of the model's parameters.
bool isNear(const VectorXd& theta, const info::Estimate& other, const VectorXd& priorSds,
            Index common) {
  for (Index i = 0; i < common; ++i) {
    const double sd = std::sqrt(std::max(other.covariance(i, i), 0.0));
    if (std::abs(theta[i] - other.parameters[i]) > std::max(3 * sd, 1e-3 * priorSds[i]))
      return false;
  }
  return true;
}

/// ½Σ((θ − μ)/d)²
double priorCost(const VectorXd& theta, const std::vector<info::Parameter>& parameters) {
  double sum = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (const auto& prior = parameters[i].prior)
      sum += std::pow((theta[static_cast<Index>(i)] - prior->mean) / prior->sd, 2) / 2;
  }
  return sum;
}

double lowestCost(const std::vector<info::StartOutcome>& starts) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const info::StartOutcome& start : starts) lowest = std::min(lowest, start.cost);
  return lowest;
}

}  // namespace

bool OtherMinimum::isLikely() const {
  return difference <= 4.6;
}

bool OtherMinimum::isPossibleByData() const {
  return ofData <= 1.92;
}

OtherMinima otherMinima(const info::LeastSquares& least,
                        const std::vector<info::StartOutcome>& starts, const VectorXd& priorSds,
                        Index common, info::Estimate estimate,
                        const info::EstimateOptions& options) {
  OtherMinima result;
  result.best = std::move(estimate);
  if (starts.empty()) return result;
  const double lowest = lowestCost(starts);
  std::vector<info::Estimate> ends;
  for (const info::StartOutcome& start : starts) {
    if (!start.converged || start.cost > lowest + worthRefining) continue;
    const auto isSeen = [&](const info::Estimate& end) {
      return isNear(start.parameters, end, priorSds, common);
    };
    if (isSeen(result.best) || std::any_of(ends.begin(), ends.end(), isSeen)) continue;
    std::optional<info::Estimate> found = info::estimateIfDefined(least, start.parameters, options);
    if (!found) continue;
    info::Estimate end = std::move(*found);
    result.iterations += end.iterations;
    result.evaluations += end.evaluations;
    if (!end.converged || isNear(end.parameters, result.best, priorSds, common)) continue;
    if (end.cost < result.best.cost) std::swap(end, result.best);
    ends.push_back(std::move(end));
  }
  std::sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  for (const info::Estimate& end : ends) {
    if (end.cost > result.best.cost + worthRefining) break;
    result.candidates.push_back(end.parameters);
    OtherMinimum other{end.parameters, end.covariance.diagonal().cwiseMax(0).cwiseSqrt(),
                       end.cost - result.best.cost, 0};
    other.ofData = other.difference - priorCost(end.parameters, least.parameters()) +
                   priorCost(result.best.parameters, least.parameters());
    if (other.isLikely() || other.isPossibleByData()) result.others.push_back(std::move(other));
  }
  return result;
}

}  // namespace bio
