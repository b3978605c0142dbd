#pragma once

#include "robot/robot_search.h"

namespace app {

/// Finds the motion that is most informative about the robot's parameters, and simulates the
/// experiment with the initial and the optimised motion: motion_initial.csv, motion_optimised.csv,
/// search.json. Status 1 if the search made no progress.
ExitStatus optimiseRobot(const OptimiseRequest& request, const CommandContext& context,
                         Summary& summary, Report& report, OutputFolder& folder);

/// The files it writes.
std::vector<std::string> optimiseFiles();

/// One function per robot, as optimiseRobot. The double pendulum of chapter 4 of Wilson's thesis,
/// that of chapter 5, and the suspended mass of section 4.5.
ExitStatus optimisePendulum(const OptimiseRequest& request, const CommandContext& context,
                            Summary& summary, Report& report, OutputFolder& folder);
ExitStatus optimisePendulumInSteps(const OptimiseRequest& request, const CommandContext& context,
                                   Summary& summary, Report& report, OutputFolder& folder);
ExitStatus optimiseSuspendedMass(const OptimiseRequest& request, const CommandContext& context,
                                 Summary& summary, Report& report, OutputFolder& folder);

/// The cart's acceleration in a motion.
info::CartMotion cartMotion(const TimedMotion& motion, std::size_t stepsPerSample);

/// One system, or several with different parameter values.
template <class System, class Make>
System systemAt(const std::vector<Eigen::Vector2d>& theta, const Make& make) {
  if (theta.size() == 1) return make(theta.front());
  std::vector<System> all;
  for (const Eigen::Vector2d& one : theta) all.push_back(make(one));
  return info::stack(std::move(all));
}

}  // namespace app
