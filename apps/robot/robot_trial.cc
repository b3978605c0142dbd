#include "robot/robot_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "bio/tables/table_file.h"
#include "output/angle_unit.h"

namespace app {
namespace {

using Eigen::Index;

[[noreturn]] void refuseTrial(const std::string& file, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}", file, what));
}

// Columns of motion_optimised.csv: what was planned, not measured.
const std::set<std::string> plannedStates = {"cart_m",
                                             "angle_rad",
                                             "angle1_rad",
                                             "angle2_rad",
                                             "cart_m_per_s",
                                             "rate_rad_per_s",
                                             "rate1_rad_per_s",
                                             "rate2_rad_per_s",
                                             "momentum1_kg_m2_per_s",
                                             "momentum2_kg_m2_per_s"};

}  // namespace

info::robot::Trial readRobotTrial(const std::string& file,
                                  const std::vector<info::robot::Channel>& channels,
                                  bool ignoreExtra, std::vector<std::string>& warnings) {
  const bio::Table table = bio::readTable(file);
  info::robot::Trial trial;
  trial.name = file;
  const Eigen::VectorXd times = bio::timesOf(table);
  if (times.size() < 2) refuseTrial(file, "holds 1 row, must hold at least 2");
  trial.times.assign(times.begin(), times.end());
  trial.measured.setConstant(times.size(), static_cast<Index>(channels.size()), std::nan(""));
  std::vector<std::string> found(channels.size());
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i];
    const auto values = table.values.col(static_cast<Index>(i));
    if (name == "time" || name == "time_s" || plannedStates.count(name) > 0) continue;
    if (name == "input") {
      for (Index k = 0; k < values.size(); ++k)
        if (!std::isfinite(values[k]))
          refuseTrial(
              file,
              fmt::format("column input: row {} is empty, must be the cart's acceleration [m/s²]",
                          k + 1));
      trial.acceleration.assign(values.begin(), values.end());
      continue;
    }
    bool known = false;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const bool isAngle = channels[c].unit == "rad", inDegrees = name == channels[c].name + "_deg";
      if (name != channels[c].name && name != channels[c].name + "_" + channels[c].unit &&
          !(isAngle && inDegrees))
        continue;
      if (!found[c].empty())
        refuseTrial(file, fmt::format("columns {} and {} have the same meaning, must be one",
                                      found[c], name));
      known = true;
      found[c] = name;
      const bool turn = isAngle && (inDegrees || (name == channels[c].name && table.inDegrees));
      trial.measured.col(static_cast<Index>(c)) = (turn ? degree : 1) * values;
      const double largest = trial.measured.col(static_cast<Index>(c))
                                 .array()
                                 .isNaN()
                                 .select(0, trial.measured.col(static_cast<Index>(c)).array().abs())
                                 .maxCoeff();
      if (isAngle && largest > 20)
        refuseTrial(file,
                    fmt::format("column {}: {:.4g} rad, must be within ±20 rad; degrees are called "
                                "{}_deg",
                                name, largest, channels[c].name));
    }
    if (known) continue;
    const std::string what = fmt::format("column {} is unknown", name);
    if (!ignoreExtra) refuseTrial(file, what + "; --ignore-extra ignores it");
    warnings.push_back(fmt::format("{}: {} and ignored", file, what));
  }
  if (trial.acceleration.empty())
    refuseTrial(file, "has no column input, must have the cart's commanded acceleration [m/s²]");
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (found[c].empty())
      refuseTrial(file, fmt::format("has no column {}_{}", channels[c].name,
                                    channels[c].unit == "rad"
                                        ? "deg (or _rad), must have the measured angle"
                                        : "N, must have the measured force"));
  return trial;
}

}  // namespace app
