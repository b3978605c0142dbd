#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bio/tables/trial.h"
#include "options/simulation_options.h"
#include "output/command_context.h"

namespace app {

/// A request to find the effect that a model lacks.
struct ModelDiscoveryRequest {
  std::string model;                 ///< file
  std::vector<std::string> trials;   ///< files, with a measured coordinate
  std::vector<std::string> heldOut;  ///< files of held-out trials
  std::vector<std::string> without;  ///< ids of effects to leave out of the catalogue
  std::vector<std::string> effects;  ///< files of effects of the user's own
  /// Standard deviation of every measured angle [deg], or of the position that is measured alone
  /// [m].
  std::optional<double> noise;
  std::vector<std::string> outputNoise;  ///< NAME=VALUE, in the unit in which that output is shown
  int maxEffects = 3;                    ///< largest number of effects in one hypothesis
  std::optional<double> inputScatter;    ///< of --input-scatter
  std::optional<double> timeLimit;       ///< [s] of elapsed time
  SimulationOptions simulation;
  bool plays = true;  ///< the report plays the motion
};

struct ModelDiscovery {
  ExitStatus status;
  nlohmann::ordered_json verdict;  ///< verdict.json
};

/// The coordinates in question: all free ones; where none is free, those that are prescribed or
/// held and whose moment the trials measure, or without trials all of them.
/// @throws std::invalid_argument if there is none
std::vector<std::string> coordinatesInQuestion(const SimulationOptions& simulation,
                                               const std::vector<bio::Trial>& trials);

/// Searches, writes verdict.json, the model with the effect and a report, and delivers them.
/// @throws std::exception for bad input, Interrupted after Ctrl-C
ModelDiscovery discoverInModel(ModelDiscoveryRequest request, const CommandContext& context);

}  // namespace app
