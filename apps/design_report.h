#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/experiment_design.h"
#include "info/monte_carlo.h"
#include "report.h"
#include "summary.h"

namespace app {

/// What `design` found.
struct DesignFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::ExperimentDesign& design;
  const bio::DesignResult& result;
  const bio::Coordinate& coordinate;
  std::vector<bio::ModelParameter> parameters;       ///< asked for, then nuisance
  std::optional<info::MonteCarloResult> monteCarlo;  ///< of the parameters asked for
};

void tellDesign(const DesignFindings& findings, Summary& summary);

Report designReport(const DesignFindings& findings);

}  // namespace app
