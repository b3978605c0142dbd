#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "output/command_context.h"
#include "output/output_folder.h"
#include "output/progress_bar.h"
#include "output/summary.h"
#include "report/report.h"
#include "robot/robot_trials.h"
#include "robots/robot_motion.h"

/// The search for a robot's motion, as it is told and written.
namespace app {

using info::robot::MotionRequest;
using info::robot::MotionResult;
using info::robot::TimedMotion;

/// A progress bar for each thing that a robot's work does; must outlive the work.
class WorkBars {
 public:
  info::robot::WorkProgress progress();

 private:
  std::mutex mutex_;
  std::string doing_;
  std::optional<ProgressBar> bar_;
};

/// The inputs of a motion's table, column `input`.
/// @throws bio::FileError if there are not `count` of them
std::vector<double> readInputs(const std::string& file, std::size_t count);

/// Writes motion_initial.csv, motion_optimised.csv and search.json, and adds the course of the
/// search to the summary and the report.
void tellSearch(const MotionResult& found, Summary& summary, Report& report, OutputFolder& folder);

/// `done`, or `answerIsNo` with the reason in the report if there was no progress.
ExitStatus statusOf(const MotionResult& found, Report& report);

}  // namespace app
