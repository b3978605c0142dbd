#pragma once

#include <optional>

#include "output/command_context.h"
#include "output/summary.h"
#include "report/report.h"
#include "robots/robot_experiments.h"

namespace app {

/// Information of an experiment: Fisher information, Cramér–Rao bound and, with `trials`, simulated
/// experiments. Status 1 if the parameters are not separately identifiable; the map of β then shows
/// why.
ExitStatus tellInformation(const info::PlannedExperiment& plan, std::optional<int> trials,
                           const CommandContext& context, Summary& summary, Report& report);

/// Convergence of three estimators on the suspended mass: on `quiet` with exact data, then on a
/// livelier motion with one noisy recording.
ExitStatus tellConvergence(const info::PlannedExperiment& quiet, const CommandContext& context,
                           Summary& summary, Report& report);

}  // namespace app
