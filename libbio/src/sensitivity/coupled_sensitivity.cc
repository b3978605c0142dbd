#include "bio/sensitivity/coupled_sensitivity.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "sensitivity/parameter_directions.h"
#include "sensitivity/sensitivity_pass.h"
#include "sensitivity/sensitivity_run.h"

namespace bio {
namespace {

void checkNodes(const ExternalNodes& nodes, const MusculoskeletalSystem& system) {
  if (nodes.times.empty()) return;
  bool rises = nodes.times.size() >= 2;
  for (std::size_t k = 0; k + 1 < nodes.times.size(); ++k) {
    rises = rises && nodes.times[k] < nodes.times[k + 1];
  }
  if (!rises) {
    throw std::invalid_argument("nodes of the external force: must be at least 2 and rise in time");
  }
  const int n = system.skeleton().numCoordinates();
  for (const int k : nodes.coordinates) {
    if (k >= 0 && k < n && std::count(nodes.coordinates.begin(), nodes.coordinates.end(), k) == 1)
      continue;
    throw std::invalid_argument(
        "nodes of the external force: coordinates must be free or prescribed ones, each once");
  }
  if (nodes.coordinates.empty())
    throw std::invalid_argument("nodes of the external force: must act on a coordinate");
}

void checkSlopes(const std::vector<ExternalSlope>& slopes, const MusculoskeletalSystem& system) {
  for (const ExternalSlope& slope : slopes) {
    const auto intervals = static_cast<Eigen::Index>(slope.times.size()) - 1;
    const bool rises = std::adjacent_find(slope.times.begin(), slope.times.end(),
                                          std::greater_equal<>()) == slope.times.end();
    if (intervals < 1 || !rises || slope.first.size() != intervals ||
        slope.last.size() != intervals)
      throw std::invalid_argument(
          "slope of the external force: times must be at least 2 and rise, with a value at either "
          "end of each interval");
    if (slope.coordinate < 0 || slope.coordinate >= system.skeleton().numCoordinates())
      throw std::invalid_argument(
          "slope of the external force: coordinate must be a free or prescribed one");
  }
}

}  // namespace

double ExternalSlope::at(double t) const {
  if (t < times.front() || t > times.back()) return 0;
  const auto behind = std::upper_bound(times.begin() + 1, times.end() - 1, t);
  const auto k = static_cast<std::size_t>(behind - times.begin()) - 1;
  const double w = (t - times[k]) / (times[k + 1] - times[k]);
  const auto interval = static_cast<Eigen::Index>(k);
  return (1 - w) * first[interval] + w * last[interval];
}

SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& system,
                                                const ParameterCatalogue& catalogue,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<std::size_t>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options) {
  return simulateWithSensitivities(
      system, setting, stepping::directionsOf(catalogue, setting, wanted), trial, options);
}

SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& system,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<ParameterDirection>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options) {
  return stepping::SensitivityRun(system, setting, trial, options).sensitivities(wanted);
}

namespace stepping {

SensitivityRun::SensitivityRun(const MusculoskeletalSystem& system,
                               const ParameterCatalogue::Setting& setting,
                               const ExcitationSignal& trial, const SensitivityOptions& given)
    : system_(system), setting_(setting), trial_(trial), given_(given) {
  if (changesForces(system, given.simulation)) {
    own_ = given;
    withOwnForces(system, given.simulation, own_->simulation);
  }
  const SensitivityOptions& used = options();
  if (!isVariational(used.simulation.integrator)) {
    throw std::invalid_argument("sensitivities: integrator must be vi-adaptive, vi or vi-left");
  }
  checkNodes(used.externalNodes, system);
  checkSlopes(used.externalSlopes, system);
  driven_ = drivenExcitation(trial, muscleNames(system), setting.mapping);
  start_ = startOf(system, setting, driven_, used.simulation.startTime);
  checkSimulation(system, driven_, start_, used.simulation);
  motion_ = simulateVariational(system, driven_, start_, used.simulation, &tape_);
  completeStates(system, driven_, motion_);
  addReactions(system, driven_, used.simulation, motion_);
}

SensitivityTrajectory SensitivityRun::sensitivities(const std::vector<ParameterDirection>& wanted) {
  for (const ExternalSlope& slope : options().externalSlopes) {
    if (slope.column < 0 || slope.column >= static_cast<Eigen::Index>(wanted.size()))
      throw std::invalid_argument(
          "slope of the external force: column must be that of a parameter wanted");
  }
  const ParameterEffects effects(system_, setting_, wanted);
  return withCoordinates(system_.skeleton(), [&](auto N) {
    SensitivityPass<decltype(N)::value> pass(system_, effects, setting_, trial_, driven_,
                                             static_cast<Eigen::Index>(wanted.size()), options());
    return pass.run(std::move(motion_), start_, tape_);
  });
}

}  // namespace stepping
}  // namespace bio
