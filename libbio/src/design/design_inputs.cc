#include "bio/design/design_inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Those with a torque.
std::vector<CoordinateLimits> torqued(const MusculoskeletalSystem& system,
                                      const DesignLimits& limits) {
  std::vector<CoordinateLimits> torques;
  const auto& all = limits.coordinates;
  for (const CoordinateLimits& own : all) {
    const std::string& name = own.coordinate;
    const int index = system.skeleton().indexOf(name);
    require(index >= 0 && !system.isPrescribed(index),
            fmt::format("limits of '{}': must be a free coordinate", name));
    require(
        std::count_if(all.begin(), all.end(),
                      [&](const CoordinateLimits& other) { return other.coordinate == name; }) == 1,
        fmt::format("limits of '{}' are given twice, must be given once", name));
    require(own.torque >= 0 && std::isfinite(own.torque),
            fmt::format("largest torque on '{}' = {}, must be ≥ 0", name, own.torque));
    require(own.lower < own.upper,
            fmt::format("range of '{}': {} to {}, must rise", name, own.lower, own.upper));
    require(own.speed > 0, fmt::format("largest speed of '{}' = {}, must be > 0", name, own.speed));
    if (own.torque > 0) torques.push_back(own);
  }
  return torques;
}

std::vector<info::ProfileLimits> profileLimits(const DesignLimits& limits,
                                               const std::vector<CoordinateLimits>& torques,
                                               std::size_t groups) {
  require(limits.leastExcitation >= 0 && limits.largestExcitation <= 1,
          fmt::format("excitations {} to {}, must be within 0 to 1", limits.leastExcitation,
                      limits.largestExcitation));
  require(limits.robustness >= 0, fmt::format("surprise = {}, must be ≥ 0", limits.robustness));
  std::vector<info::ProfileLimits> inputs;
  for (const CoordinateLimits& torque : torques) {
    inputs.push_back({-torque.torque, torque.torque, limits.torqueRate, 0.0});
  }
  for (std::size_t g = 0; g < groups; ++g) {
    inputs.push_back({limits.leastExcitation, limits.largestExcitation, limits.excitationRate, {}});
  }
  return inputs;
}

/// The torque on a coordinate that no actuator of the model exerts; null if there is none.
template <class Forces>
auto torqueIn(Forces& forces, const std::string& coordinate) {
  const auto at = std::find_if(forces.begin(), forces.end(), [&](const AppliedForce& force) {
    return force.coordinate == coordinate && force.actuator.empty();
  });
  return at == forces.end() ? nullptr : &*at;
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
    const VectorXd control = force.control;
    if (control.size() > 0) force.control.resize(trial.times.size());
    for (Index k = 0; k < trial.times.size(); ++k) {
      const info::LinearWeights here = info::linearAt(given.times, trial.times[k]);
      force.values[k] = here.value(values);
      if (control.size() > 0) force.control[k] = here.value(control);
    }
  }
  return trial;
}

}  // namespace

DesignInputs::DesignInputs(const MusculoskeletalSystem& system, Trial trial, double startTime,
                           double duration, DesignLimits limits, std::vector<MuscleGroup> groups,
                           double knotInterval, std::vector<double> measuredTimes)
    : limits_(std::move(limits)),
      torques_(torqued(system, limits_)),
      groups_(std::move(groups)),
      measuredTimes_(std::move(measuredTimes)),
      profiles_(knotsOf(startTime, duration, knotInterval),
                profileLimits(limits_, torques_, groups_.size())) {
  require(profiles_.size() > 0, "no input to design, must have a torque or a muscle");
  std::vector<std::string> seen;
  for (const MuscleGroup& group : groups_) {
    require(!group.muscles.empty(),
            fmt::format("group '{}' has no muscle, must have one", group.name));
    columns_.emplace_back();
    for (const std::string& name : group.muscles) {
      const bool known = std::any_of(system.muscles().begin(), system.muscles().end(),
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
  std::vector<double> rows(trial.times.begin(), trial.times.end());
  for (const MeasuredChannel& course : trial.prescribed) {
    if (course.times.size() > 1) rows = merged(rows, {course.times.begin(), course.times.end()});
  }
  trial_ = onRows(trial, merged(merged(rows, profiles_.knots()), measuredTimes_));
}

std::vector<MeasuredChannel> DesignInputs::measured(const std::vector<Observable>& observables,
                                                    const MatrixXd& values) const {
  const VectorXd times =
      VectorXd::Map(measuredTimes_.data(), static_cast<Index>(measuredTimes_.size()));
  std::vector<MeasuredChannel> channels;
  for (const Observable& what : observables) {
    channels.push_back({what, times, values.col(static_cast<Index>(channels.size()))});
  }
  return channels;
}

Trial DesignInputs::at(const VectorXd& x) const {
  Trial trial = trial_;
  if (x.size() == 0) return trial;
  const MatrixXd values =
      profiles_.values(x, std::vector<double>(trial.times.begin(), trial.times.end()));
  Index input = 0;
  for (const CoordinateLimits& limits : torques_) {
    AppliedForce* known = torqueIn(trial.applied, limits.coordinate);
    if (!known) known = &trial.applied.emplace_back(AppliedForce{limits.coordinate, {}});
    known->values = values.col(input++);
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
  for (Index k = 0; k < K; ++k) {
    const double t = profiles_.knots()[static_cast<std::size_t>(k)];
    Index input = 0;
    const info::LinearWeights here = info::linearAt(trial_.times, t);
    for (const CoordinateLimits& limits : torques_)
      atKnots(k, input++) = here.value(torqueOf(trial_, limits.coordinate));
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

VectorXd DesignInputs::torqueOf(const Trial& trial, const std::string& coordinate) const {
  const AppliedForce* force = torqueIn(trial.applied, coordinate);
  return force ? force->values : VectorXd::Zero(trial.times.size());
}

double DesignInputs::largestTorqueRate(const Trial& trial, const std::string& coordinate) const {
  return largestSlope(trial.times, torqueOf(trial, coordinate));
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

Table plannedTable(const MusculoskeletalSystem& system, const Trial& trial) {
  const Index rows = trial.times.size();
  Table table;
  table.name = "designed experiment";
  table.values.resize(rows, 0);
  const auto add = [&](const std::string& name, const VectorXd& values) {
    table.columns.push_back(name);
    table.values.conservativeResize(Eigen::NoChange, table.values.cols() + 1);
    table.values.rightCols(1) = values;
  };
  const auto addSamples = [&](const MeasuredChannel& channel) {
    VectorXd values = VectorXd::Constant(rows, std::numeric_limits<double>::quiet_NaN());
    Index row = 0;
    for (Index i = 0; i < channel.times.size(); ++i) {
      while (row + 1 < rows && trial.times[row] < channel.times[i] - sameTime) ++row;
      values[row] = channel.values[i];
    }
    add(nameOf(channel.what), values);
  };
  add("time", trial.times);
  for (Index m = 0; m < trial.excitations.cols(); ++m) {
    add(trial.muscles[static_cast<std::size_t>(m)], trial.excitations.col(m));
  }
  for (const AppliedForce& force : trial.applied) {
    if (!force.actuator.empty()) {
      add(force.actuator, force.control);
      continue;
    }
    const int index = system.skeleton().indexOf(force.coordinate);
    const bool turns =
        index < 0 || system.skeleton().coordinates()[static_cast<std::size_t>(index)].isRotation;
    add(force.coordinate + (turns ? ".torque" : ".force"), force.values);
  }
  for (const MeasuredChannel& course : trial.prescribed) {
    if (course.times.size() > 1) {
      addSamples(course);
    } else {
      add(nameOf(course.what), VectorXd::Constant(rows, course.values[0]));
    }
  }
  std::vector<std::string> predicted;
  for (const MeasuredChannel& channel : trial.measured) {
    addSamples(channel);
    predicted.push_back(nameOf(channel.what));
  }
  table.metadata["predicted"] =
      fmt::format("{} {} predicted, not measured", fmt::join(predicted, ", "),
                  predicted.size() == 1 ? "is" : "are");
  table.metadata.merge(headerOf(trial.conditions));
  return table;
}

}  // namespace bio
