#pragma once

#include <string>
#include <vector>

#include "robots/robot_effects.h"

namespace app {

/// A recording of a robot from a table, as info::robot::recordingOf takes it; empty cells: not
/// measured.
/// @param warnings gets a line for each column ignored because of `ignoreExtra`
/// @throws bio::FileError; std::invalid_argument naming file, column and rule
info::robot::Trial readRobotTrial(const std::string& file,
                                  const std::vector<info::robot::Channel>& channels,
                                  bool ignoreExtra, std::vector<std::string>& warnings);

}  // namespace app
