#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"
#include "report/report.h"

/// Motions that a report plays in three dimensions: computed here, drawn by report/playback.js.
namespace app {

/// A simulated motion to play.
struct PlayedMotion {
  std::string name;  ///< "simulated", "calibrated"
  const bio::Model& model;
  const bio::MusculoskeletalSystem& system;  ///< of the model
  const bio::Trajectory& motion;
};

/// Motions of one trial, the one shown first first.
struct PlayedTrial {
  std::string name;         ///< its file
  const bio::Trial* trial;  ///< with what was measured, for the ghost; null: nothing was
  std::vector<PlayedMotion> motions;
};

/// Free coordinates that are neither prescribed nor measured: while there is one, there is no
/// measured posture.
std::vector<std::string> unmeasuredCoordinates(const bio::MusculoskeletalSystem& system,
                                               const bio::Trial& trial);

/// Trials in one section; a reader chooses one of them.
inline constexpr std::size_t mostPlayedTrials = 6;

/// A section that plays motions. It takes at most about 0.9 MB: at most 120 frames of each motion,
/// fewer if they are large, and of many trials only the first.
/// @param wrapAsCylinder  with which the systems were made
/// @param numTrials  that there are, if they are more than these
/// @return nothing if there is nothing to draw: no motion, or no bodies with an extent
std::optional<Playback> playbackOf(const std::string& title, const std::vector<PlayedTrial>& trials,
                                   const std::vector<std::string>& wrapAsCylinder,
                                   std::size_t numTrials = 0);

}  // namespace app
