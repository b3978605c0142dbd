#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm_discovery.h"
#include "bio/discover/effect_size.h"
#include "bio/discover/repaired.h"
#include "output_folder.h"
#include "summary.h"

namespace app {

/// What a search in an arm leaves beside verdict and report, and what replays of it give.
struct WrittenDiscovery {
  std::string model;  ///< of the folder: the model with all that was fitted; empty: none
  std::vector<bio::discover::RepairedTrial> trials;
  std::vector<std::string> replayFiles;  ///< what to replay in the place of each trial; as typed
  std::optional<bio::discover::Repaired> repaired;
  int shown = 0;  ///< the trial along whose motion `sizes` are: held out if one is
  std::vector<bio::discover::EffectSize> sizes;               ///< of Verdict::effects
  std::vector<std::pair<std::string, std::string>> commands;  ///< figure, and what remakes it
};

/// The files that writeDiscovery may write.
std::vector<std::string> namesOfDiscovery(std::size_t training, std::size_t heldOut);

/// What a search has found, and where.
struct DiscoveryInArm {
  const ArmDiscoveryRequest& request;
  const std::vector<std::string>& files;  ///< of all trials, those held out last
  const bio::discover::ElbowDisagreement& data;
  const info::discover::Verdict& verdict;
  const std::vector<int>& heldOut;
};

/// Writes with_effect.osim (or refitted.osim, where nothing is missing), effect_only.osim and,
/// where EMG or sensor are at fault or a muscle was switched on, the trials as they should have
/// been: driven_N.sto and driven_held_out_N.sto. Without a folder the figures are the same.
/// @param summary  its inputs are where all this comes from
WrittenDiscovery writeDiscovery(const DiscoveryInArm& found, Summary& summary,
                                OutputFolder& folder);

}  // namespace app
