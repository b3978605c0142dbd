#pragma once

#include <memory>

#include "command/command.h"
#include "robot_options/discover_robot.h"

/// fisherhill-robot, the program beside this one that does the work of `robot` and of
/// `discover --system`, so that nothing else has to be compiled with the robots' dynamics.
namespace app {

/// Becomes fisherhill-robot where the words ask for a robot; returns where they do not, or where
/// that program is not there.
void becomeRobotProgram(char** argv);

/// `robot` where fisherhill-robot is not there: says how to build it.
std::unique_ptr<Command> missingRobotCommand();

/// `discover --system` likewise.
/// @throws std::runtime_error always
ExitStatus missingRobotDiscovery(const RobotRequest& request, const CommandContext& context);

/// `robot` itself. Defined in fisherhill-robot only.
std::unique_ptr<Command> robotCommand();

}  // namespace app
