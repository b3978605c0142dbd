#pragma once

#include <string>
#include <vector>

#include "robots/robot_effects.h"

namespace app {

/// A recording of a robot from a table: `time` [s], `input` (the cart's commanded acceleration,
/// m/s², linear between rows; every row) and one column per channel of the model, e.g. `link1_deg`,
/// `link1_rad` or `force_N`; empty cells: not measured. The planned states that `fisherhill robot`
/// writes as further columns are ignored.
/// @param warnings gets a line for each column ignored because of `ignoreExtra`
/// @throws bio::FileError; std::invalid_argument naming file, column and rule
info::robot::Trial readRobotTrial(const std::string& file,
                                  const std::vector<info::robot::Channel>& channels,
                                  bool ignoreExtra, std::vector<std::string>& warnings);

}  // namespace app
