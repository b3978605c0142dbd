#pragma once

#include <optional>
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
  std::optional<Playback> playback = {};
};

/// The designed motion in three dimensions, and that of the trial given, without either effect.
/// @param system      of the model
/// @param simulation  integrator and step
std::optional<Playback> separatingPlayback(const SeparatingFindings& findings,
                                           const bio::SystemOptions& system,
                                           const bio::SimulationOptions& simulation);

void tellSeparation(const SeparatingFindings& findings, Summary& summary);

Report separatingReport(const SeparatingFindings& findings);

}  // namespace app
