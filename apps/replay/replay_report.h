#pragma once

#include <optional>
#include <string>

#include "bio/analysis/replay.h"
#include "bio/analysis/step_effect.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "report/report.h"

namespace app {

/// A simulated trial with its inputs.
struct ReplayFindings {
  const std::string& modelFile;
  const std::string& trialFile;
  const bio::Model& model;
  const bio::Trial& trial;
  const bio::MusculoskeletalSystem& system;
  const bio::TrialReplay& replay;
  const bio::MuscleReport& muscles;
  const std::optional<bio::LeftRange>& left;
  const std::optional<bio::StepEffect>& effect;
  std::optional<Playback> playback = {};
};

/// Sets the values of summary.json: rms_error_deg, newton_iterations_per_step, …
void tellReplay(const ReplayFindings& findings, Summary& summary);

/// Simulated and measured angle, excitations, activations, forces, moment arms, energy.
Report replayReport(const ReplayFindings& findings);

}  // namespace app
