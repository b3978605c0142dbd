#include "bio/design/design_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info/dynamics/linear_table.h"
#include "info/probability/random_stream.h"
#include "model/require.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double sameTime = 1e-9;  ///< times nearer than this are one [s]

/// Knots at most `interval` apart, equally spaced, from start to end.
std::vector<double> knotsOf(double start, double duration, double interval) {
  require(interval > 0 && duration / interval < 1e4,
          fmt::format("interval of the knots = {} s, must be > 0 and not tiny", interval));
  const double parts = std::max(1.0, std::ceil(duration / interval - 1e-9));
  std::vector<double> knots;
  for (double k = 0; k <= parts; ++k) knots.push_back(start + duration * k / parts);
  return knots;
}

/// Both, sorted; where two are together, the first list's.
std::vector<double> merged(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> all = first;
  for (const double t : second) {
    const auto at = std::lower_bound(first.begin(), first.end(), t - sameTime);
    if (at == first.end() || *at > t + sameTime) all.push_back(t);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<info::ProfileLimits> profileLimits(const DesignLimits& limits, std::size_t groups) {
  require(limits.torque >= 0 && std::isfinite(limits.torque),
          fmt::format("largest torque = {} N·m, must be ≥ 0", limits.torque));
  require(limits.leastExcitation >= 0 && limits.largestExcitation <= 1,
          fmt::format("excitations {} to {}, must be within 0 to 1", limits.leastExcitation,
                      limits.largestExcitation));
  require(limits.lower < limits.upper,
          fmt::format("range {} to {}, must rise", limits.lower, limits.upper));
  require(limits.surprise >= 0, fmt::format("surprise = {}, must be ≥ 0", limits.surprise));
  require(limits.speed > 0, fmt::format("largest speed = {}, must be > 0", limits.speed));
  std::vector<info::ProfileLimits> inputs;
  if (limits.torque > 0) inputs.push_back({-limits.torque, limits.torque, limits.torqueRate, 0.0});
  for (std::size_t g = 0; g < groups; ++g) {
    inputs.push_back({limits.leastExcitation, limits.largestExcitation, limits.excitationRate, {}});
  }
  return inputs;
}

double largestSlope(const VectorXd& times, const VectorXd& values) {
  double largest = 0;
  for (Index k = 0; k + 1 < times.size(); ++k) {
    largest = std::max(largest, std::abs(values[k + 1] - values[k]) / (times[k + 1] - times[k]));
  }
  return largest;
}

Trial onRows(const Trial& given, const std::vector<double>& rows) {
  Trial trial = given;
  trial.times = Eigen::Map<const VectorXd>(rows.data(), static_cast<Index>(rows.size()));
  trial.excitations.resize(trial.times.size(), given.excitations.cols());
  for (Index k = 0; k < trial.times.size(); ++k) {
    trial.excitations.row(k) = info::linearAt(given.times, trial.times[k]).rows(given.excitations);
  }
  for (AppliedForce& force : trial.applied) {
    const VectorXd values = force.values;
    force.values.resize(trial.times.size());
    for (Index k = 0; k < trial.times.size(); ++k) {
      force.values[k] = info::linearAt(given.times, trial.times[k]).value(values);
    }
  }
  return trial;
}

}  // namespace

DesignInputs::DesignInputs(const MusculoskeletalSystem& arm, Trial trial, std::string coordinate,
                           double startTime, double duration, const DesignLimits& limits,
                           std::vector<MuscleGroup> groups, double knotInterval,
                           std::vector<double> measuredTimes)
    : coordinate_(std::move(coordinate)),
      limits_(limits),
      groups_(std::move(groups)),
      measuredTimes_(std::move(measuredTimes)),
      profiles_(knotsOf(startTime, duration, knotInterval), profileLimits(limits, groups_.size())) {
  require(profiles_.size() > 0, "no input to design, must have a torque or a muscle");
  std::vector<std::string> seen;
  for (const MuscleGroup& group : groups_) {
    require(!group.muscles.empty(),
            fmt::format("group '{}' has no muscle, must have one", group.name));
    columns_.emplace_back();
    for (const std::string& name : group.muscles) {
      const bool known = std::any_of(arm.muscles().begin(), arm.muscles().end(),
                                     [&](const SystemMuscle& m) { return m.name == name; });
      require(known, fmt::format("'{}' must be a muscle that moves in the model", name));
      require(std::count(seen.begin(), seen.end(), name) == 0,
              fmt::format("muscle '{}' is in two groups, must be in one", name));
      seen.push_back(name);
      const auto column = std::find(trial.muscles.begin(), trial.muscles.end(), name);
      require(column != trial.muscles.end(), fmt::format("the trial has no muscle '{}'", name));
      columns_.back().push_back(column - trial.muscles.begin());
    }
  }
  const std::vector<double> given(trial.times.begin(), trial.times.end());
  trial_ = onRows(trial, merged(merged(given, profiles_.knots()), measuredTimes_));
}

Trial DesignInputs::at(const VectorXd& x) const {
  Trial trial = trial_;
  if (x.size() == 0) return trial;
  const MatrixXd values =
      profiles_.values(x, std::vector<double>(trial.times.begin(), trial.times.end()));
  Index input = 0;
  if (hasTorque()) {
    const auto known =
        std::find_if(trial.applied.begin(), trial.applied.end(),
                     [&](const AppliedForce& force) { return force.coordinate == coordinate_; });
    AppliedForce& force = known != trial.applied.end()
                              ? *known
                              : trial.applied.emplace_back(AppliedForce{coordinate_, {}});
    force.values = values.col(input++);
  }
  for (const auto& columns : columns_) {
    for (const Index column : columns) trial.excitations.col(column) = values.col(input);
    ++input;
  }
  return trial;
}

VectorXd DesignInputs::own() const {
  const auto K = static_cast<Index>(profiles_.knots().size());
  MatrixXd atKnots = MatrixXd::Zero(K, static_cast<Index>(profiles_.inputs().size()));
  const VectorXd torque = torqueOf(trial_);
  for (Index k = 0; k < K; ++k) {
    const double t = profiles_.knots()[static_cast<std::size_t>(k)];
    Index input = 0;
    const info::LinearWeights here = info::linearAt(trial_.times, t);
    if (hasTorque()) atKnots(k, input++) = here.value(torque);
    for (const auto& columns : columns_) {
      for (const Index column : columns) {
        atKnots(k, input) +=
            here.value(trial_.excitations.col(column)) / static_cast<double>(columns.size());
      }
      ++input;
    }
  }
  return profiles_.project(profiles_.coefficients(atKnots));
}

VectorXd DesignInputs::random(std::uint64_t seed, std::uint64_t which) const {
  info::RandomStream random(seed, which);
  const double size = std::pow(2.0, -3 * random.uniform());
  VectorXd walk(profiles_.size());
  double at = 0;
  for (Index k = 0; k < walk.size(); ++k) walk[k] = at = 0.8 * at + 0.6 * random.normal();
  return profiles_.project(own() + size * walk);
}

VectorXd DesignInputs::torqueOf(const Trial& trial) const {
  for (const AppliedForce& force : trial.applied) {
    if (force.coordinate == coordinate_) return force.values;
  }
  return VectorXd::Zero(trial.times.size());
}

double DesignInputs::largestTorqueRate(const Trial& trial) const {
  return largestSlope(trial.times, torqueOf(trial));
}

double DesignInputs::largestExcitationRate(const Trial& trial) const {
  double largest = 0;
  for (const auto& columns : columns_) {
    for (const Index column : columns) {
      largest = std::max(largest, largestSlope(trial.times, trial.excitations.col(column)));
    }
  }
  return largest;
}

}  // namespace bio
