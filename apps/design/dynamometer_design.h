#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/design/dynamometer_plan.h"
#include "command/command.h"
#include "options/simulation_options.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// `design --dynamometer`, as typed.
struct DynamometerOptions {
  std::string coordinate;
  std::vector<std::string> angles;  ///< held at; the first and the last are turned between
  std::vector<std::string> speeds;  ///< of turns [.../s]
  std::vector<double> efforts = {30, 60, 100};  ///< [% MVC]
  int count = 4;
  double momentNoise = 0.5;  ///< [N·m] > 0, of a sample
};

/// "Hold at 60 deg; 2 s of rest, then …": to the person on the dynamometer.
std::string instructionOf(const bio::DynamometerExperiment& experiment, bool turns);

void tellDynamometer(const bio::DynamometerPlan& plan, bool turns, Summary& summary);
Report dynamometerReport(const bio::DynamometerPlan& plan, const DynamometerOptions& options,
                         bool turns);

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer);

/// bio::planOnDynamometer, as the options ask for it.
/// @throws std::invalid_argument for an option out of its range
ExitStatus designOnDynamometer(const CommandContext& context, const std::string& modelFile,
                               const std::vector<std::string>& parameters,
                               const std::vector<std::string>& nuisance,
                               const DynamometerOptions& dynamometer, double rate,
                               const SimulationOptions& simulation);

}  // namespace app
