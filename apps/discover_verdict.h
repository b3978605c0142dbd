#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bio/discover/elbow_disagreement.h"
#include "info/discover/discover.h"

namespace app {

/// What was found, and all that it was made of.
struct DiscoverFindings {
  const std::string& modelFile;
  const std::vector<std::string>& trialFiles;  ///< those held out last
  const bio::discover::ElbowDisagreement& data;
  const info::discover::Options& options;
  const info::discover::Verdict& verdict;
  const std::string& nextExperiment;
  bool isAngle;        ///< outputs are shown in degrees
  double wallSeconds;  ///< of the search
};

/// verdict.json as design/cli.md has it.
nlohmann::ordered_json verdictJson(const DiscoverFindings& findings);

/// "named", or "ambiguous", "parameter", "none", "unknown", "numerical"; "stopped" if the work did
/// not reach its end.
std::string verdictWord(const info::discover::Verdict& verdict);

}  // namespace app
