#pragma once

#include "bio/arm.h"
#include "bio/coupled.h"
#include "simulation_options.h"

namespace app {

/// The typed model options as the library wants them.
bio::ArmOptions armOptions(const SimulationOptions& options);

/// The typed simulation options for a duration [s] from a start time [s].
bio::SimulationOptions simulationOptions(const SimulationOptions& options, double startTime,
                                         double duration);

/// NAME=VALUE pairs by name. @throws std::invalid_argument for a name given twice
std::map<std::string, double> byName(const std::vector<Assignment>& assignments);

}  // namespace app
