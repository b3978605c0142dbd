#include "robot/robot_optimise.h"

namespace app {

std::vector<std::string> optimiseFiles() {
  return {"motion_initial.csv", "motion_optimised.csv", "search.json"};
}

info::CartMotion cartMotion(const TimedMotion& motion, std::size_t stepsPerSample) {
  info::CartMotion cart{{}, motion.step, stepsPerSample};
  for (const Eigen::VectorXd& u : motion.u) cart.acceleration.push_back(u[0]);
  return cart;
}

ExitStatus optimiseRobot(const OptimiseRequest& request, const CommandContext& context,
                         Summary& summary, Report& report, OutputFolder& folder) {
  if (!request.warmStart.empty()) summary.addInput(request.warmStart);
  if (!request.pendulum) return optimiseSuspendedMass(request, context, summary, report, folder);
  return request.discrete ? optimisePendulumInSteps(request, context, summary, report, folder)
                          : optimisePendulum(request, context, summary, report, folder);
}

}  // namespace app
