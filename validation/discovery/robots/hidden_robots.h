#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/random_numbers.h"
#include "robots/true_robots.h"

namespace hidden {

/// One thing that can be hidden in a robot.
struct RobotEffect {
  std::string id;    ///< also the number of the plant that it sets
  std::string kind;  ///< structure, input, sensor, parameter
  bool inCatalogue;  ///< false: the tool has no name for it
  std::string law;   ///< with the sign convention
  std::string unit;
  double fullSize;  ///< amplitude at --size 1; of a parameter its relative change
  std::vector<std::string> equivalents;
  bool eitherSign;  ///< by seed, unless named on the command line
  /// false: hidden only where it is asked for by name, so that the seeds of earlier suites go on to
  /// mean what they meant.
  bool bySeed = true;
};

/// A robot of the blind benchmark.
struct RobotKind {
  std::string name;   ///< double-pendulum or suspended-mass
  Numbers nominal;    ///< as the tool's model has it
  Numbers tolerance;  ///< deviations of the logarithms of those numbers from plant to plant
  std::vector<RobotEffect> effects;
  std::vector<std::string> columns;  ///< of the measured values
  std::vector<double> noise;         ///< [rad] or [N]
  bool inDegrees;
  double interval;  ///< between rows [s]
  void (*observe)(const Numbers& plant, RobotRecord& record, double tolerance);
};

/// @throws std::invalid_argument for an unknown name
const RobotKind& robotKind(const std::string& name);
std::string robotEffectsAsMarkdown();

struct RobotPlan {
  std::string system;
  std::uint64_t seed = 0;
  /// null, single, parameter, two or out, as for the elbow
  std::string suite = "single";
  std::vector<std::string> effects;  ///< ids; empty: chosen by seed
  double size = 1;
  double inputNoise = 0;  ///< of the cart's acceleration, 80 ms Ornstein–Uhlenbeck [m/s²]
  double nuisances = 1;   ///< share of the plants' usual departures
  double seconds = 5;
};

struct RobotTrial {
  std::string name;
  RobotRecord record;
  std::vector<std::vector<double>> read;  ///< with noise, as in the file
};

struct RobotDataSet {
  std::vector<RobotTrial> trials;  ///< train_1, train_2, train_3, held_out
  nlohmann::ordered_json label;
};

/// @throws std::invalid_argument for a plan that cannot be
std::vector<std::string> chosenEffects(const RobotPlan& plan);
RobotDataSet makeRobotDataSet(const RobotPlan& plan);
std::string asTable(const RobotKind& kind, const RobotTrial& trial, const std::string& title);
/// As writeDataSet does for the elbow.
void writeRobotDataSet(const RobotDataSet& set, const RobotKind& kind,
                       const std::filesystem::path& folder, const std::filesystem::path& labels);

}  // namespace hidden
