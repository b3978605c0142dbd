#include "bio/coupled_sensitivity.h"

#include <stdexcept>

#include "sensitivity_pass.h"

namespace bio {

std::vector<std::string> muscleNames(const Arm& arm) {
  std::vector<std::string> names;
  for (const ArmMuscle& muscle : arm.muscles()) names.push_back(muscle.name);
  return names;
}

ArmState startOf(const Arm& arm, const ParameterCatalogue::Setting& setting,
                 const ExcitationSignal& driven, double time) {
  ArmState start = initialState(arm, setting.start.q, driven, time);
  start.qDot = setting.start.qDot;
  return start;
}

Trajectory simulateSetting(const Arm& arm, const ParameterCatalogue::Setting& setting,
                           const ExcitationSignal& trial, const SimulationOptions& options) {
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(arm), setting.mapping);
  return simulate(arm, driven, startOf(arm, setting, driven, options.startTime), options);
}

SensitivityTrajectory simulateWithSensitivities(const Arm& arm, const ParameterCatalogue& catalogue,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<std::size_t>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options) {
  const Integrator integrator = options.simulation.integrator;
  if (integrator != Integrator::variational && integrator != Integrator::variationalLeft) {
    throw std::invalid_argument("sensitivities: the integrator must be vi or vi-left");
  }
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(arm), setting.mapping);
  const ArmState start = startOf(arm, setting, driven, options.simulation.startTime);
  stepping::checkSimulation(arm, driven, start, options.simulation);
  stepping::StepTape tape;
  Trajectory motion = stepping::simulateVariational(arm, driven, start, options.simulation, &tape);
  const stepping::ParameterEffects effects(arm, catalogue, setting, wanted);
  return stepping::withCoordinates(arm.skeleton().numCoordinates(), [&](auto N) {
    stepping::SensitivityPass<decltype(N)::value> pass(
        arm, effects, setting, trial, driven, static_cast<Eigen::Index>(wanted.size()), options);
    return pass.run(std::move(motion), start, tape);
  });
}

}  // namespace bio
