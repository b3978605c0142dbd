#pragma once

#include <string>

#include "bio/design/separating_design.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// Result of `design --separate`.
struct SeparatingFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Model& model;
  const bio::discover::SeparatingDesign& design;
  const bio::discover::SeparatingResult& result;
  bio::SystemOptions system;          ///< of the model
  bio::SimulationOptions simulation;  ///< integrator and step
};

void tellSeparation(const SeparatingFindings& findings, Summary& summary);

Report separatingReport(const SeparatingFindings& findings);

}  // namespace app
