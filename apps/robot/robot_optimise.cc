#include "robot/robot_optimise.h"

#include <fmt/format.h>

#include "robot/robot_methods.h"

namespace app {
namespace {

MotionResult optimised(MotionRequest request) {
  WorkBars bars;
  request.progress = bars.progress();
  try {
    return info::robot::optimiseMotion(request);
  } catch (const info::NoInformation& e) {
    throw std::invalid_argument(fmt::format(
        "{}: --perturb 0.05 adds a small smooth motion, --amplitude a larger one", e.what()));
  }
}

}  // namespace

std::vector<std::string> optimiseFiles() {
  return {"motion_initial.csv", "motion_optimised.csv", "search.json"};
}

ExitStatus optimiseRobot(MotionRequest request, const std::string& warmStart,
                         const CommandContext& context, Summary& summary, Report& report,
                         OutputFolder& folder) {
  if (!warmStart.empty()) {
    summary.addInput(warmStart);
    request.warmStart = readInputs(warmStart, info::robot::numInputs(request));
  }
  request.seed = context.seed;
  request.threads = context.threads;
  const MotionResult found = optimised(request);
  if (!request.pendulum) {
    tellSuspendedMass(found, context, summary, report);
  } else if (request.discrete) {
    tellPendulumInSteps(found, request.stepsPerSample, summary, report);
  } else {
    tellPendulum(found, context, summary, report);
  }
  tellSearch(found, summary, report, folder);
  sayMotion(request, found, summary.methods());
  return statusOf(found, report);
}

}  // namespace app
