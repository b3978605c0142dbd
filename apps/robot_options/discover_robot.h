#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output/command_context.h"

namespace app {

/// Request of `fisherhill discover --system SYSTEM TRIAL…`.
struct RobotRequest {
  std::string system;         ///< double-pendulum or suspended-mass; empty: no robot
  std::string with;           ///< a with_effect.json; empty: the plain model
  std::vector<double> noise;  ///< standard deviation of each measured column, in the unit of the
                              ///< file; empty: estimated
  std::vector<std::string> trials, heldOut, without;
  std::optional<double> step;  ///< [s]
  int maxEffects = 3;
  std::optional<double> timeLimit;  ///< [s]
  std::optional<double> inputScatter;
  bool ignoreExtra = false;
};

/// Adds --system and --with.
void addRobotOptions(CLI::App& options, RobotRequest& request);

/// Action of `discover --system` on its request.
using RobotDiscovery = std::function<ExitStatus(const RobotRequest&, const CommandContext&)>;

/// Finds, names and adds the effect that a robot's model lacks; writes verdict.json and, if an
/// effect was named, with_effect.json. Defined in fisherhill-robot only.
/// @throws std::invalid_argument, bio::FileError for bad input
ExitStatus discoverInRobot(const RobotRequest& request, const CommandContext& context);

}  // namespace app
