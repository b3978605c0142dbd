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

bio::SystemOptions armOptions(const SimulationOptions& options) {
  bio::SystemOptions arm;
  arm.skeleton.freeCoordinates = options.coordinates;
  arm.skeleton.lockedValues = byName(options.locks);
  arm.prescribed = options.prescribed;
  arm.prescribed.insert(arm.prescribed.end(), options.prescribedByModel.begin(),
                        options.prescribedByModel.end());
  for (const auto& [name, value] : options.held) {
    arm.prescribed.push_back(name);
    arm.skeleton.lockedValues.erase(name);
  }
  arm.skeleton.freeCoordinates.insert(arm.skeleton.freeCoordinates.end(), arm.prescribed.begin(),
                                      arm.prescribed.end());
  arm.wrapAsCylinder = options.wrapAsCylinder;
  return arm;
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
