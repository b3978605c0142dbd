#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "command/command_context.h"
#include "options/simulation_options.h"

namespace app {

/// A request to find the effect that a model lacks.
struct ModelDiscoveryRequest {
  std::string model;                   ///< file
  std::vector<std::string> trials;     ///< files, with a measured coordinate
  std::vector<std::string> heldOut;    ///< files of held-out trials
  std::vector<std::string> without;    ///< ids of effects to leave out of the catalogue
  std::optional<double> noise;         ///< standard deviation of what was measured [deg] or [m]
  int maxEffects = 3;                  ///< largest number of effects in one hypothesis
  std::optional<double> inputScatter;  ///< of --input-scatter
  SimulationOptions simulation;
};

struct ModelDiscovery {
  ExitStatus status;
  nlohmann::ordered_json verdict;  ///< verdict.json
};

/// The one free coordinate, which discover observes.
/// @throws std::invalid_argument unless there is exactly one
std::string observedCoordinate(const SimulationOptions& simulation);

/// Searches, writes verdict.json, the model with the effect and a report, and delivers them.
/// @throws std::exception for bad input, Interrupted after Ctrl-C
ModelDiscovery discoverInModel(ModelDiscoveryRequest request, const CommandContext& context);

}  // namespace app
