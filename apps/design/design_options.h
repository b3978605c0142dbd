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
  std::vector<std::string> parameters, nuisance, givenPriors, excite, range, separate, sizes;
  bool priors = false;
  double noise_deg = 0.5, rate_Hz = 100, speed_deg = 500, knots = 0.3;
  bio::DesignLimits limits = {};
  bio::DesignSearchSettings settings = {};
  int monteCarlo = 0;
  DynamometerOptions dynamometer;
  SimulationOptions simulation;
  /// Options that only a search from a trial uses.
  std::vector<const CLI::Option*> ofSearch;
  /// Options of the angle, which of a dynamometer's experiments only isotonic ones measure.
  std::vector<const CLI::Option*> ofAngle;
};

void addDesignOptions(CLI::App& options, DesignOptions& typed);

/// @throws std::invalid_argument for options that do not go together, or a number out of its range
void checkDesignOptions(const DesignOptions& typed);

}  // namespace app
