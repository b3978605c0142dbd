#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/discovery/predicted_experiments.h"
#include "info/discovery/discover.h"
#include "info/discovery/likelihood/fitted_numbers.h"
#include "output/summary.h"

namespace app {

/// A measured output and its unit in the report.
struct ShownOutput {
  std::string name;  ///< e.g. "elbow_flexion"
  std::string unit;  ///< e.g. "deg"
};

/// Words and units of the report, for one kind of system.
struct DiscoverWording {
  std::vector<ShownOutput> outputs;  ///< by DiscoveryProblem::outputOfSample
  double unit = 1;                   ///< factor from internal values to shown ones
  std::string gapEnd;                ///< suffix of names in verdict.json: "_deg", "_m" or "_N"
  std::string force;                 ///< the latent force: "Torque [N·m]"
  std::string forceUnit;             ///< "N·m"
  std::string ofForce;               ///< unit of its size: "fraction of the muscles' moments"
  std::string push;                  ///< disturbance that a score tests: "a push"
  std::string inputs, input;         ///< "muscles", "muscle"
  std::string commands;              ///< the inputs: "excitations"
  bool hasMap = true;                ///< false: no score map over the first output and its rate
  std::map<std::string, std::string> present;  ///< effects that the model already has, and where
};

struct WrittenDiscovery;

/// The findings with their inputs.
struct DiscoverFindings {
  const std::string& modelFile;
  const std::vector<std::string>& trialFiles;  ///< those held out last
  const info::discover::DiscoveryProblem& data;
  const DiscoverWording& wording;
  const info::discover::Options& options;
  const info::discover::Verdict& verdict;
  const std::string& nextExperiment;
  const std::vector<bio::discover::PredictedExperiment>& predictedExperiments;
  double wallSeconds;       ///< of the search
  double processorSeconds;  ///< of the search, which has one thread
  const std::vector<info::discover::FittedNumber>& fitted;
  const WrittenDiscovery* written = nullptr;  ///< for musculoskeletal models
  double step = 0;                            ///< time step of the final search [s]
};

/// Sets the values of summary.json.
void tellFindings(const DiscoverFindings& findings, Summary& summary);

/// verdict.json as docs/schemas/verdict.schema.json describes it.
nlohmann::ordered_json verdictJson(const DiscoverFindings& findings);

/// "named", or "ambiguous", "parameter", "none", "unknown", "numerical"; "stopped" if the search
/// did not reach its end.
std::string verdictWord(const info::discover::Verdict& verdict);

}  // namespace app
