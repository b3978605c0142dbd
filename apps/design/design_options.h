#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/design/experiment_design.h"
#include "design/dynamometer_design.h"
#include "options/simulation_options.h"

namespace app {

/// `design`, as typed.
struct DesignOptions {
  std::string model, trial, criterion = "E";
  std::vector<std::string> parameters, nuisance, givenPriors, excite, separate, sizes;
  std::vector<std::string> observe;        ///< NAME=SD each; empty: the free coordinates
  std::vector<std::string> range, torque;  ///< [NAME=]LOW,HIGH and [NAME=]N m each
  bool priors = false;
  double noise_deg = 0.5, rate_Hz = 100, speed_deg = 500, knots = 0.3;
  bio::DesignLimits limits = {};
  bio::DesignSearchSettings settings = {};
  int monteCarlo = 0;
  DynamometerOptions dynamometer;
  SimulationOptions simulation;
  const CLI::Option* noise = nullptr;
  /// Those that only free coordinates have.
  std::vector<const CLI::Option*> ofMotion;
  /// Those that only a search from a trial uses.
  std::vector<const CLI::Option*> ofSearch;
  /// Options of the angle, which of a dynamometer's experiments only isotonic ones measure.
  std::vector<const CLI::Option*> ofAngle;
};

void addDesignOptions(CLI::App& options, DesignOptions& typed);

/// @throws std::invalid_argument for options that do not go together, or a number out of its range
void checkDesignOptions(const DesignOptions& typed);

/// @throws std::invalid_argument what bio::withCoordinates throws, text of another kind, or an
///   option of free coordinates where there is none
bio::DesignLimits designLimits(const DesignOptions& typed,
                               const bio::MusculoskeletalSystem& system);

/// The observed channels: as typed, else all free coordinates.
/// @throws std::invalid_argument what readObserved throws, or if there is nothing
std::vector<bio::ChannelCandidate> designOutputs(const DesignOptions& typed,
                                                 const bio::Model& model,
                                                 const bio::MusculoskeletalSystem& system);

}  // namespace app
