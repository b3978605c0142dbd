#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/tables/trial.h"

namespace bio::discover {

/// The relation between the command τ of a drive, a column of a trial, and its force on the
/// coordinate:
///     τ′(t) = g·S(τ_L(t − d)),   lag·τ̇_L = τ − τ_L,   τ_L = τ at the first row,
///     S(x) = x − a·sign(x)·E(|x| − s),   E(y) = max(0, y), of |y| < w = s/20 (y + w)²/4w
/// Before its first row the command was as there. τ_L is exact at the rows of a command that is
/// straight between them; τ′ is straight between these times + d. The default is τ itself.
struct DriveLaw {
  double gain = 1;   ///< g [1]
  double delay = 0;  ///< d [s] ≥ 0
  double lag = 0;    ///< time constant [s] ≥ 0
  double share = 0;  ///< a [1], of what exceeds the limit; 1: it saturates
  double limit = 1;  ///< s [N·m] or [N] > 0

  /// Whether the force is the command.
  bool isTrue() const { return gain == 1 && delay == 0 && lag == 0 && share == 0; }
};

/// By coordinate; only those that are not true.
using DriveLaws = std::map<std::string, DriveLaw>;

/// τ′ at its corners, with its derivatives there. ∂τ′/∂delay is −dτ′/dt but where the command was
/// constant before its first row.
struct DrivenCourse {
  std::vector<double> times;  ///< [s] from the command's first row to its last
  Eigen::VectorXd values;
  Eigen::VectorXd inGain, inLag, inShare, inLimit;
  /// ∂τ′/∂delay between a corner and the next.
  Eigen::VectorXd inDelay;
};
/// @param times of the command [s] strictly rising, at least two
DrivenCourse drivenCourse(const Eigen::VectorXd& times, const Eigen::VectorXd& command,
                          const DriveLaw& law);

/// The trial as drives without errors would have needed it: with rows at the corners of τ′, and
/// with the controls of actuators that make it. Other columns are straight between their rows.
Trial withDrives(Trial trial, const DriveLaws& laws);

/// What trials command of one coordinate.
struct DriveCommand {
  std::string coordinate;
  double largest = 0;  ///< magnitude of the commands [N·m] or [N] > 0
  /// The actuators whose controls all commands are, by name; empty: some are torques or forces.
  std::vector<std::string> actuators = {};
};
/// Those coordinates of `names` that a torque, force or control which is not constant drives in a
/// trial.
std::vector<DriveCommand> commandsOf(const std::vector<Trial>& trials,
                                     const std::vector<std::string>& names);
/// A command of size 1 on every coordinate: before there are trials, any may be driven.
std::vector<DriveCommand> possibleCommands(const std::vector<std::string>& names);

/// Quantities of an encompassing model between the commands of a coordinate and its force.
struct Drive {
  DriveCommand command;
  std::optional<std::size_t> gain = {}, delay = {}, lag = {}, share = {}, limit = {};
  bool owns(std::size_t quantity) const {
    return quantity == gain || quantity == delay || quantity == lag || quantity == share ||
           quantity == limit;
  }
};
/// What they are at values of all quantities.
DriveLaw driveLaw(const Drive& drive, const Eigen::VectorXd& values);

}  // namespace bio::discover
