#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command_context.h"

namespace app {

/// What `fisherhill discover --system SYSTEM TRIAL…` was asked for.
struct RobotRequest {
  std::string system;  ///< double-pendulum or suspended-mass; empty: not asked for a robot
  std::string with;    ///< a with_effect.json; empty: the plain model
  std::vector<double>
      noise;  ///< of each measured column, in its unit as read; empty: from the data
  std::vector<std::string> trials, heldOut, without;
  std::optional<double> step;  ///< [s]
  int maxEffects = 3;
  std::optional<double> inputScatter;
  bool ignoreExtra = false;
};

/// Adds --system, --with and --noise.
void addRobotOptions(CLI::App& options, RobotRequest& request);

/// Finds, names and adds what a robot's model lacks; writes verdict.json and, where something was
/// named, with_effect.json.
/// @throws std::invalid_argument, bio::FileError for bad input
ExitStatus discoverInRobot(const RobotRequest& request, const CommandContext& context);

}  // namespace app
