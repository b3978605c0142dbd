#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace app {

/// One row of an interval drawing; values in a scale shared by all rows.
struct IntervalRow {
  std::string name;
  std::optional<double> estimate = {};
  std::optional<std::pair<double, double>> interval = {};  ///< interval of the estimate
  std::optional<std::pair<double, double>> before = {};    ///< interval of the prior
};

/// Draws intervals below each other, each with its name: the prior in grey, the estimate's interval
/// in blue, a dot at the estimate. Infinite ends reach the edge.
/// @param xLabel  of the shared scale
std::string intervalDrawing(const std::vector<IntervalRow>& rows, const std::string& xLabel);

}  // namespace app
