#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "robots/robot_effects.h"

namespace info::robot {

/// A recording as a table: one row per time.
struct RecordedTable {
  std::string name;                  ///< named in messages
  std::vector<std::string> columns;  ///< unique
  Eigen::MatrixXd values;            ///< NaN: not measured
  bool inDegrees = false;            ///< of angles whose column has no unit in its name
};

/// A recording of a robot: `time` [s], `input` (the cart's commanded acceleration, m/s², linear
/// between rows; every row) and one column per channel of the model, e.g. `link1_deg`, `link1_rad`
/// or `force_N`; NaN: not measured. The planned states that `fisherhill robot` writes as further
/// columns are ignored.
/// @param unknown called with each column that means nothing here; it may throw
/// @throws std::invalid_argument naming table, column and rule
Trial recordingOf(const RecordedTable& table, const std::vector<Channel>& channels,
                  const std::function<void(const std::string& column)>& unknown);

}  // namespace info::robot
