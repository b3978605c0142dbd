#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "output/command_context.h"
#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"
#include "robots/string_length.h"

namespace app {

using BaxterRequest = info::robot::StringLengthRequest;
using BaxterTrial = info::robot::StringLengthTrial;

/// Adds the options of this robot and returns them.
std::vector<CLI::Option*> addBaxterOptions(CLI::App& options, BaxterRequest& request);

/// Runs the trials and the task: estimates.csv, samples.csv, task.csv, swing.csv and two drawings.
/// Status 1 if nothing would move; the report gives the reason.
ExitStatus runBaxter(BaxterRequest request, const CommandContext& context, Summary& summary,
                     Report& report, OutputFolder& folder);

/// The files it writes.
std::vector<std::string> baxterFiles();

/// Figures 6.3, 6.4, 6.5, 6.7 and 6.8 and table 6.1 of Wilson's thesis.
void reportBaxter(const std::vector<BaxterTrial>& trials, const BaxterRequest& request,
                  Report& report);

/// A swing as an animated drawing that repeats.
std::string swingDrawing(const info::SwingRun& run, const info::Box& box);

}  // namespace app
