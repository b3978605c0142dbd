#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/discover/foresee.h"
#include "info/discover/discover.h"
#include "info/discover/fitted_numbers.h"
#include "summary.h"

namespace app {

/// One thing that was measured, as people read it.
struct ShownOutput {
  std::string name;   ///< e.g. "elbow_flexion"
  std::string unit;   ///< e.g. "deg"
  double weight = 1;  ///< of it in Disagreement::measured
};

/// What a model's own numbers are called.
struct DiscoverWording {
  std::vector<ShownOutput> outputs;  ///< by Disagreement::outputOfSample
  double unit = 1;                   ///< outputs are shown as so many times their values
  std::string gapEnd;                ///< of names in verdict.json: "_deg", "_m" or "_N"
  std::string force;                 ///< the latent force: "Torque [N·m]"
  std::string forceUnit;             ///< "N·m"
  std::string ofForce;               ///< what its size counts: "part of the muscles' moments"
  std::string push;                  ///< what a score means: "a push"
  std::string inputs, input;         ///< "muscles", "muscle"
  std::string commands;              ///< what drives: "excitations"
  bool hasMap = true;                ///< false: the first output has no map over it and its rate
  std::map<std::string, std::string> present;  ///< effects that the model has already, and where
};

struct WrittenDiscovery;

/// What was found, and all that it was made of.
struct DiscoverFindings {
  const std::string& modelFile;
  const std::vector<std::string>& trialFiles;  ///< those held out last
  const info::discover::Disagreement& data;
  const DiscoverWording& wording;
  const info::discover::Options& options;
  const info::discover::Verdict& verdict;
  const std::string& nextExperiment;
  const std::vector<bio::discover::ForeseenExperiment>& foreseen;
  double wallSeconds;       ///< of the search
  double processorSeconds;  ///< of the search, which has one thread
  const std::vector<info::discover::FittedNumber>& fitted;
  const WrittenDiscovery* written = nullptr;  ///< of an arm
  double step = 0;                            ///< [s] that the search has ended with
};

/// The findings as figures of summary.json.
void tellFindings(const DiscoverFindings& findings, Summary& summary);

/// The contents of verdict.json.
nlohmann::ordered_json verdictJson(const DiscoverFindings& findings);

/// "named", or "ambiguous", "parameter", "none", "unknown", "numerical"; "stopped" if the work did
/// not reach its end.
std::string verdictWord(const info::discover::Verdict& verdict);

}  // namespace app
