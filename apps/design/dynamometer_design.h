#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/design/dynamometer_plan.h"
#include "command/command.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

struct DesignOptions;

/// `design --dynamometer`, as typed.
struct DynamometerOptions {
  std::string coordinate;
  std::vector<std::string> kinds;     ///< of experiments; empty: all
  std::vector<std::string> angles;    ///< held at; the first and the last are turned between
  std::vector<std::string> speeds;    ///< of turns [.../s]
  std::vector<double> efforts;        ///< [% MVC]
  std::vector<std::string> releases;  ///< lengths
  std::string releaseSpeed;           ///< the largest [.../s]
  std::vector<double> loads;          ///< of isotonic contractions [% of what holds the joint]
  int count = 4;
  double momentNoise = 0.5;  ///< [N·m] > 0, of a sample
};

/// Whether such experiments are asked for.
bool considers(const DynamometerOptions& options, bio::DynamometerExperiment::Kind kind);

const char* wordOf(bio::DynamometerExperiment::Kind kind);

/// "Hold at 60 deg; 2 s of rest, then …": to the person on the dynamometer.
std::string instructionOf(const bio::DynamometerExperiment& experiment, bool turns);

void tellDynamometer(const bio::DynamometerPlan& plan, bool turns, Summary& summary);
/// @param question  that was asked
Report dynamometerReport(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                         bool turns);

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer);

/// The lists of the options in radians (or metres) and shares.
/// @throws std::invalid_argument for an option out of its range, or one that none of the kinds uses
bio::DynamometerQuestion dynamometerQuestion(const DesignOptions& typed,
                                             const bio::Coordinate& coordinate);

/// bio::planOnDynamometer, as the options ask for it.
/// @throws std::invalid_argument for an option out of its range
ExitStatus designOnDynamometer(const CommandContext& context, const DesignOptions& typed);

}  // namespace app
