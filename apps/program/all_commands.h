#pragma once

#include <memory>
#include <vector>

#include "command/command.h"
#include "robot_options/discover_robot.h"

namespace app {

/// Every subcommand, in the order in which --help lists them. A new one is a file in a folder of
/// its own with a function that makes it, declared and called in all_commands.cc. The work with
/// robots is missing: fisherhill-robot does it.
std::vector<std::unique_ptr<Command>> allCommands();

/// Every subcommand, with this work for robots.
std::vector<std::unique_ptr<Command>> allCommandsWith(std::unique_ptr<Command> robot,
                                                      RobotDiscovery inRobot);

}  // namespace app
