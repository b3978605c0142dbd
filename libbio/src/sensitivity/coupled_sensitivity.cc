#include "bio/sensitivity/coupled_sensitivity.h"

#include <stdexcept>

#include "sensitivity/parameter_directions.h"
#include "sensitivity/sensitivity_pass.h"

namespace bio {
namespace {

void checkNodes(const ExternalNodes& nodes, const MusculoskeletalSystem& arm) {
  if (nodes.times.empty()) return;
  bool rises = nodes.times.size() >= 2;
  for (std::size_t k = 0; k + 1 < nodes.times.size(); ++k) {
    rises = rises && nodes.times[k] < nodes.times[k + 1];
  }
  if (!rises) {
    throw std::invalid_argument("nodes of the external force: must be at least 2 and rise in time");
  }
  if (nodes.coordinate < 0 || nodes.coordinate >= arm.skeleton().numCoordinates()) {
    throw std::invalid_argument("nodes of the external force: coordinate must be a free one");
  }
}

}  // namespace

std::vector<std::string> muscleNames(const MusculoskeletalSystem& arm) {
  std::vector<std::string> names;
  for (const SystemMuscle& muscle : arm.muscles()) names.push_back(muscle.name);
  return names;
}

SystemState startOf(const MusculoskeletalSystem& arm, const ParameterCatalogue::Setting& setting,
                    const ExcitationSignal& driven, double time) {
  SystemState start = initialState(arm, setting.start.q, driven, time);
  start.qDot = setting.start.qDot;
  return start;
}

Trajectory simulateSetting(const MusculoskeletalSystem& arm,
                           const ParameterCatalogue::Setting& setting,
                           const ExcitationSignal& trial, const SimulationOptions& options) {
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(arm), setting.mapping);
  return simulate(arm, driven, startOf(arm, setting, driven, options.startTime), options);
}

SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& arm,
                                                const ParameterCatalogue& catalogue,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<std::size_t>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options) {
  return simulateWithSensitivities(arm, setting, stepping::directionsOf(catalogue, setting, wanted),
                                   trial, options);
}

SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& arm,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<ParameterDirection>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& given) {
  SensitivityOptions own;
  const bool isChanged = stepping::changesForces(arm, given.simulation);
  if (isChanged) {
    own = given;
    stepping::withOwnForces(arm, given.simulation, own.simulation);
  }
  const SensitivityOptions& options = isChanged ? own : given;
  const Integrator integrator = options.simulation.integrator;
  if (integrator != Integrator::variational && integrator != Integrator::variationalLeft) {
    throw std::invalid_argument("sensitivities: integrator must be vi or vi-left");
  }
  checkNodes(options.externalNodes, arm);
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(arm), setting.mapping);
  const SystemState start = startOf(arm, setting, driven, options.simulation.startTime);
  stepping::checkSimulation(arm, driven, start, options.simulation);
  stepping::StepTape tape;
  Trajectory motion = stepping::simulateVariational(arm, driven, start, options.simulation, &tape);
  stepping::completeStates(arm, driven, motion);
  stepping::addReactions(arm, driven, options.simulation, motion);
  const stepping::ParameterEffects effects(arm, setting, wanted);
  return stepping::withCoordinates(arm.skeleton(), [&](auto N) {
    stepping::SensitivityPass<decltype(N)::value> pass(
        arm, effects, setting, trial, driven, static_cast<Eigen::Index>(wanted.size()), options);
    return pass.run(std::move(motion), start, tape);
  });
}

}  // namespace bio
