#include "robots/robot_recording.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>

namespace info::robot {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kLargestAngle = 20;                // [rad]; more are degrees

[[noreturn]] void refuse(const RecordedTable& table, const std::string& what) {
  throw std::invalid_argument(fmt::format("{}: {}", table.name, what));
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

bool isTime(const std::string& column) {
  return column == "time" || column == "time_s";
}

VectorXd timesOf(const RecordedTable& table) {
  std::optional<std::size_t> at;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (isTime(table.columns[i]) && (!at || table.columns[i] == "time")) at = i;
  if (!at) refuse(table, "has no column time, must have the times [s]");
  return table.values.col(static_cast<Index>(*at));
}

/// The factor from a column to the channel's unit; none: the column is another channel's.
std::optional<double> factorOf(const std::string& column, const Channel& channel,
                               const RecordedTable& table) {
  const bool isAngle = channel.unit == "rad", inDegrees = column == channel.name + "_deg";
  if (column != channel.name && column != channel.name + "_" + channel.unit &&
      !(isAngle && inDegrees))
    return {};
  return isAngle && (inDegrees || (column == channel.name && table.inDegrees)) ? kDegree : 1.0;
}

std::vector<double> accelerationOf(const VectorXd& values, const RecordedTable& table) {
  for (Index k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      refuse(table,
             fmt::format("column input: row {} is empty, must be the cart's acceleration [m/s²]",
                         k + 1));
  return {values.begin(), values.end()};
}

void mustBeRadians(const VectorXd& angles, const std::string& column, const Channel& channel,
                   const RecordedTable& table) {
  const double largest = angles.array().isNaN().select(0, angles.array().abs()).maxCoeff();
  if (largest > kLargestAngle)
    refuse(table, fmt::format("column {}: {:.4g} rad, must be within ±{} rad; degrees are called "
                              "{}_deg",
                              column, largest, kLargestAngle, channel.name));
}

}  // namespace

Trial recordingOf(const RecordedTable& table, const std::vector<Channel>& channels,
                  const std::function<void(const std::string& column)>& unknown) {
  Trial trial;
  trial.name = table.name;
  const VectorXd times = timesOf(table);
  if (times.size() < 2)
    refuse(table, fmt::format("holds {} row{}, must hold at least 2", times.size(),
                              times.size() == 1 ? "" : "s"));
  trial.times.assign(times.begin(), times.end());
  trial.measured.setConstant(times.size(), static_cast<Index>(channels.size()), std::nan(""));
  std::vector<std::string> found(channels.size());
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i];
    const VectorXd values = table.values.col(static_cast<Index>(i));
    if (isTime(name) || plannedStates.count(name) > 0) continue;
    if (name == "input") {
      trial.acceleration = accelerationOf(values, table);
      continue;
    }
    bool known = false;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const std::optional<double> factor = factorOf(name, channels[c], table);
      if (!factor) continue;
      if (!found[c].empty())
        refuse(table,
               fmt::format("columns {} and {} have the same meaning, must be one", found[c], name));
      known = true;
      found[c] = name;
      trial.measured.col(static_cast<Index>(c)) = *factor * values;
      if (channels[c].unit == "rad")
        mustBeRadians(trial.measured.col(static_cast<Index>(c)), name, channels[c], table);
    }
    if (!known) unknown(name);
  }
  if (trial.acceleration.empty())
    refuse(table, "has no column input, must have the cart's commanded acceleration [m/s²]");
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (found[c].empty())
      refuse(table,
             fmt::format("has no column {}_{}", channels[c].name,
                         channels[c].unit == "rad" ? "deg (or _rad), must have the measured angle"
                                                   : "N, must have the measured force"));
  return trial;
}

}  // namespace info::robot
