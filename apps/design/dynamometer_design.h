#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/design/dynamometer_question.h"
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

void tellDynamometer(const bio::DynamometerPlan& plan, bool turns, Summary& summary);
/// @param question  that was asked
Report dynamometerReport(const bio::DynamometerPlan& plan, const bio::DynamometerQuestion& question,
                         bool turns);

void addDynamometerOptions(CLI::App& options, DynamometerOptions& dynamometer);

/// bio::withDefaults of the lists of the options.
/// @throws what that throws; std::invalid_argument for text that is no quantity
bio::DynamometerQuestion dynamometerQuestion(const DesignOptions& typed,
                                             const bio::Coordinate& coordinate);

/// bio::planOnDynamometer, as the options ask for it.
/// @throws std::invalid_argument for an option out of its range
ExitStatus designOnDynamometer(const CommandContext& context, const DesignOptions& typed);

}  // namespace app
