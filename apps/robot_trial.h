#pragma once

#include <string>
#include <vector>

#include "info/systems/robot_effects.h"

namespace app {

/// A recording of a robot from a table: `time` [s], `input` (the cart's commanded acceleration,
/// m/s², linear between rows; every row) and one column per channel of the model, e.g. `link1_deg`,
/// `link1_rad` or `force_N`; empty cells: not measured. What `fisherhill robot` writes beside time
/// and input, the states that it planned, is passed over.
/// @param warnings  gains a line for each column passed over because of `ignoreExtra`
/// @throws bio::FileError; std::invalid_argument naming file, column and rule
info::robot::Trial readRobotTrial(const std::string& file,
                                  const std::vector<info::robot::Channel>& channels,
                                  bool ignoreExtra, std::vector<std::string>& warnings);

}  // namespace app
