#include "calibration/checked_intervals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "info/estimation/profile_likelihood.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Shares of the rise of the cost, z²/2, that still confirm an interval.
constexpr double leastRise = 0.7, mostRise = 1.4;
/// Fall of the cost that makes another search worth while [nats], and the most searches.
constexpr double worthwhileFall = 0.02;
constexpr int mostSearches = 4;

/// Where an interval ends if the cost is a parabola: one number at its end, all others at their
/// best for it.
struct IntervalEnd {
  VectorXd theta;
  double rise = 0;  ///< of the cost [nats]; infinite: no simulation
};

/// Nothing where the number has no width, or where its bound comes first.
std::optional<IntervalEnd> endOf(const info::LeastSquares& least, const VectorXd& estimate,
                                 double cost, const MatrixXd& covariance, Index i, double z) {
  const double sd = std::sqrt(covariance(i, i));
  if (!(sd > 0 && std::isfinite(sd)) || !covariance.col(i).allFinite()) return {};
  IntervalEnd end{estimate + z * covariance.col(i) / sd};
  for (Index k = 0; k < end.theta.size(); ++k) {
    const info::Parameter& parameter = least.parameters()[static_cast<std::size_t>(k)];
    const double within = std::clamp(end.theta[k], parameter.lower, parameter.upper);
    if (k == i && within != end.theta[k]) return {};
    end.theta[k] = within;
  }
  end.rise = least.cost(end.theta) - cost;
  if (std::isnan(end.rise)) end.rise = std::numeric_limits<double>::infinity();
  return end;
}

void withoutInterval(CalibratedParameter& parameter, const std::string& reason) {
  parameter.sd = parameter.lower = parameter.upper = std::numeric_limits<double>::quiet_NaN();
  parameter.identifiable = false;
  parameter.why = fmt::format("no interval of {}: {}", parameter.asked.name, reason);
}

/// Takes the ends of the profile likelihood.
void follow(const info::LeastSquares& least, const info::Estimate& estimate, Index i, double sd,
            const info::EstimateOptions& options, CalibratedParameter& parameter) {
  const info::ProfileInterval found = info::profileInterval(least, estimate, i, sd, options);
  const auto lowest = std::min_element(
      found.profile.points.begin(), found.profile.points.end(),
      [](const info::ProfilePoint& a, const info::ProfilePoint& b) { return a.cost < b.cost; });
  if (lowest != found.profile.points.end() && lowest->cost < estimate.cost - 0.5) {
    return withoutInterval(parameter,
                           fmt::format("the data fit better at {:.4g}, from where the search "
                                       "did not go on; try --starts",
                                       lowest->value));
  }
  if (!std::isfinite(found.lower) || !std::isfinite(found.upper)) {
    return withoutInterval(parameter,
                           fmt::format("the likelihood does not bound it {}",
                                       std::isfinite(found.upper) ? "from below" : "from above"));
  }
  parameter.lower = found.lower;
  parameter.upper = found.upper;
  parameter.sd = (found.upper - found.lower) / (2 * info::normalQuantile(options.confidence));
  parameter.byLikelihood = true;
}

}  // namespace

info::Estimate betterBeside(const info::LeastSquares& least, info::Estimate estimate, Index common,
                            const info::EstimateOptions& options) {
  const double z = info::normalQuantile(options.confidence);
  for (int search = 0; search < mostSearches; ++search) {
    std::optional<IntervalEnd> lowest;
    for (Index i = 0; i < common; ++i) {
      for (const double side : {-z, z}) {
        auto end = endOf(least, estimate.parameters, estimate.cost, estimate.covariance, i, side);
        if (end && (!lowest || end->rise < lowest->rise)) lowest = std::move(end);
      }
    }
    if (!lowest || lowest->rise > -worthwhileFall) break;
    std::optional<info::Estimate> found = info::estimateIfDefined(least, lowest->theta, options);
    if (!found) break;
    info::Estimate next = std::move(*found);
    next.iterations += estimate.iterations;
    next.evaluations += estimate.evaluations;
    if (!(next.cost < estimate.cost) || (estimate.converged && !next.converged)) {
      estimate.iterations = next.iterations;
      estimate.evaluations = next.evaluations;
      break;
    }
    estimate = std::move(next);
  }
  return estimate;
}

void checkIntervals(const info::LeastSquares& least, const info::Estimate& estimate,
                    const MatrixXd& covariance, Index common, const info::EstimateOptions& options,
                    std::vector<CalibratedParameter>& parameters) {
  const double z = info::normalQuantile(options.confidence);
  for (Index i = 0; i < common; ++i) {
    CalibratedParameter& parameter = parameters[static_cast<std::size_t>(i)];
    if (std::isnan(parameter.sd)) continue;
    if (!estimate.converged) {
      withoutInterval(
          parameter, fmt::format("the search did not converge ({})", info::describe(estimate.why)));
      continue;
    }
    double fewest = std::numeric_limits<double>::infinity(), most = 0;
    for (const double side : {-z, z}) {
      const auto end = endOf(least, estimate.parameters, estimate.cost, covariance, i, side);
      if (!end) continue;
      fewest = std::min(fewest, end->rise / (z * z / 2));
      most = std::max(most, end->rise / (z * z / 2));
    }
    if (fewest >= leastRise && most <= mostRise) continue;
    try {
      follow(least, estimate, i, parameter.sd, options, parameter);
    } catch (const std::domain_error& error) {
      withoutInterval(parameter, fmt::format("its profile likelihood: {}", error.what()));
    }
  }
}

void encloseMinima(const std::vector<OtherMinimum>& minima, Index common, double confidence,
                   std::vector<CalibratedParameter>& parameters) {
  const double z = info::normalQuantile(confidence);
  for (const OtherMinimum& minimum : minima) {
    for (Index i = 0; i < common; ++i) {
      CalibratedParameter& parameter = parameters[static_cast<std::size_t>(i)];
      const double value = minimum.values[i], sd = minimum.sd[i];
      if (std::isnan(parameter.lower) || (value >= parameter.lower && value <= parameter.upper))
        continue;
      const double half = std::isfinite(sd) ? z * sd : 0;
      parameter.lower = std::max(parameter.asked.lower, std::min(parameter.lower, value - half));
      parameter.upper = std::min(parameter.asked.upper, std::max(parameter.upper, value + half));
      parameter.sd = std::numeric_limits<double>::quiet_NaN();
      parameter.identifiable = false;
      parameter.why = fmt::format(
          "{} = {:.5g}{} fits as well as {:.5g}: the interval encloses both", parameter.asked.name,
          value, parameter.asked.unit.empty() ? "" : " " + parameter.asked.unit, parameter.value);
    }
  }
}

}  // namespace bio
