#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/design/experiment_design.h"
#include "info/estimation/monte_carlo.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// Result of `design`.
struct DesignFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Model& model;
  const bio::ExperimentDesign& design;
  const bio::DesignResult& result;
  std::vector<bio::ModelParameter> parameters;       ///< of interest, then nuisance
  std::optional<info::MonteCarloResult> monteCarlo;  ///< for the parameters of interest
  std::optional<Playback> playback = {};
};

/// The designed motion in three dimensions, and that of the trial given.
/// @param wrapAsCylinder  of the system's options
std::optional<Playback> designPlayback(const DesignFindings& findings,
                                       const std::vector<std::string>& wrapAsCylinder);

void tellDesign(const DesignFindings& findings, Summary& summary);

Report designReport(const DesignFindings& findings);

}  // namespace app
