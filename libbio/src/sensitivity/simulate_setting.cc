#include "bio/emg/emg_mapping.h"
#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio {

std::vector<std::string> muscleNames(const MusculoskeletalSystem& system) {
  std::vector<std::string> names;
  for (const SystemMuscle& muscle : system.muscles()) names.push_back(muscle.name);
  return names;
}

SystemState startOf(const MusculoskeletalSystem& system, const ParameterCatalogue::Setting& setting,
                    const ExcitationSignal& driven, double time) {
  SystemState start = initialState(system, setting.start.q, driven, time);
  start.qDot = setting.start.qDot;
  return start;
}

Trajectory simulateSetting(const MusculoskeletalSystem& system,
                           const ParameterCatalogue::Setting& setting,
                           const ExcitationSignal& trial, const SimulationOptions& options) {
  const ExcitationSignal driven = drivenExcitation(trial, muscleNames(system), setting.mapping);
  return simulate(system, driven, startOf(system, setting, driven, options.startTime), options);
}

}  // namespace bio
