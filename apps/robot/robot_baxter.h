#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "command/command_context.h"
#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"
#include "robots/active_estimation.h"
#include "robots/box_task.h"

namespace app {

/// Options of `fisherhill robot baxter`.
struct BaxterRequest {
  bool realTime = false;        ///< four threads at their own rates instead of simulated time
  double duration = 6;          ///< of a trial [s]
  std::vector<double> initial;  ///< initial lengths [m]; empty: the nine of chapter 6
  double payload = 0.2;         ///< [kg]
  double trueLength = 0.368;    ///< [m]
  double noise = 0.1;           ///< of the load cell [N]
  double disturbance = 0.5;     ///< [m/s²]
  double trackingWeight = 20;   ///< of the gripper's position
  double window = 0;            ///< [s]; 0: growing
  bool estimateMass = false, ignoreClipping = false, searchTime = false;
};

/// One trial, and the task carried out without and with the estimate.
struct BaxterTrial {
  double initialLength;
  info::ActiveEstimationResult learnt;
  info::SwingRun withoutEstimation, withEstimation;
};

/// Adds the options of this robot and returns them.
std::vector<CLI::Option*> addBaxterOptions(CLI::App& options, BaxterRequest& request);

/// Runs the trials and the task: estimates.csv, samples.csv, task.csv, swing.csv and two drawings.
/// Status 1 if nothing would move; the report gives the reason.
ExitStatus runBaxter(const BaxterRequest& request, const CommandContext& context, Summary& summary,
                     Report& report, OutputFolder& folder);

/// The files it writes.
std::vector<std::string> baxterFiles();

/// Figures 6.3, 6.4, 6.5, 6.7 and 6.8 and table 6.1 of Wilson's thesis.
void reportBaxter(const std::vector<BaxterTrial>& trials, const BaxterRequest& request,
                  Report& report);

/// A swing as an animated drawing that repeats.
std::string swingDrawing(const info::SwingRun& run, const info::Box& box);

}  // namespace app
