#pragma once

#include "robot/robot_search.h"

namespace app {

/// Finds the motion that is most informative about the robot's parameters, and simulates the
/// experiment with the initial and the optimised motion: motion_initial.csv, motion_optimised.csv,
/// search.json. Status 1 if the search made no progress.
/// @param warmStart a motion_optimised.csv to start from; empty: none
ExitStatus optimiseRobot(MotionRequest request, const std::string& warmStart,
                         const CommandContext& context, Summary& summary, Report& report,
                         OutputFolder& folder);

/// The files it writes.
std::vector<std::string> optimiseFiles();

/// Findings for the double pendulum of chapter 4 of Wilson's thesis, that of chapter 5, and
/// the suspended mass of section 4.5; before tellSearch().
void tellPendulum(const MotionResult& found, const CommandContext& context, Summary& summary,
                  Report& report);
void tellPendulumInSteps(const MotionResult& found, int stepsPerSample, Summary& summary,
                         Report& report);
void tellSuspendedMass(const MotionResult& found, const CommandContext& context, Summary& summary,
                       Report& report);

}  // namespace app
