#pragma once

#include <optional>
#include <string>

#include "command.h"
#include "output_folder.h"
#include "report.h"
#include "summary.h"

namespace app {

/// What `fisherhill robot` optimises, and from where.
struct OptimiseRequest {
  bool pendulum = true;                     ///< else the suspended mass
  bool discrete = false;                    ///< the variational integrator's motion (chapter 5)
  std::optional<double> amplitude, period;  ///< of the start, [m] and [s]
  std::optional<double> perturb;            ///< added to the start's input [unit of the input]
  std::string warmStart;                    ///< a motion_optimised.csv; empty: none
  int trials = 300;
};

/// Finds the motion that tells most about the robot's parameters, and simulates the experiment with
/// both motions: motion_initial.csv, motion_optimised.csv, search.json. Status 1 if the search made
/// no progress.
ExitStatus optimiseRobot(const OptimiseRequest& request, const CommandContext& context,
                         Summary& summary, Report& report, OutputFolder& folder);

/// The files it writes.
std::vector<std::string> optimiseFiles();

}  // namespace app
