#include "options/system_options.h"

#include <fmt/format.h>

#include <stdexcept>

#include "bio/simulation/integrator_names.h"

namespace app {

std::map<std::string, double> byName(const std::vector<Assignment>& assignments) {
  std::map<std::string, double> values;
  for (const Assignment& assignment : assignments) {
    if (!values.emplace(assignment.name, assignment.value).second) {
      throw std::invalid_argument(fmt::format("'{}' is given twice", assignment.name));
    }
  }
  return values;
}

bio::SystemOptions systemOptions(const SimulationOptions& options) {
  bio::SystemOptions system;
  system.threads = 0;  // --threads limits the program
  system.skeleton.freeCoordinates = options.coordinates;
  system.skeleton.lockedValues = byName(options.locks);
  system.prescribed = options.prescribed;
  system.prescribed.insert(system.prescribed.end(), options.prescribedByModel.begin(),
                           options.prescribedByModel.end());
  for (const auto& [name, value] : options.held) {
    system.prescribed.push_back(name);
    system.skeleton.lockedValues.erase(name);
  }
  system.skeleton.freeCoordinates.insert(system.skeleton.freeCoordinates.end(),
                                         system.prescribed.begin(), system.prescribed.end());
  system.wrapAsCylinder = options.wrapAsCylinder;
  return system;
}

bio::SimulationOptions simulationOptions(const SimulationOptions& options, double startTime,
                                         double duration) {
  bio::SimulationOptions simulation;
  simulation.integrator = bio::integratorNamed(options.integrator).value();
  simulation.startTime = startTime;
  simulation.duration = duration;
  simulation.step = options.stepOrDefault();
  return simulation;
}

}  // namespace app
