#pragma once

#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "options/simulation_options.h"

namespace app {

/// The model options of the command line as options of the library.
bio::SystemOptions systemOptions(const SimulationOptions& options);

/// The simulation options of the command line, with start time [s] and duration [s], as options of
/// the library.
bio::SimulationOptions simulationOptions(const SimulationOptions& options, double startTime,
                                         double duration);

/// NAME=VALUE pairs by name. @throws std::invalid_argument for a name given twice
std::map<std::string, double> byName(const std::vector<Assignment>& assignments);

}  // namespace app
