#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/discovery/effect_size.h"
#include "bio/discovery/repaired.h"
#include "discover/model_discovery.h"
#include "output/output_folder.h"
#include "output/summary.h"

namespace app {

/// The model, trials and commands that a search writes beside verdict and report, and their
/// replays.
struct WrittenDiscovery {
  std::string model;  ///< file name of the model with all fitted parameters; empty: none
  std::vector<bio::discover::RepairedTrial> trials;
  std::vector<std::string> replayFiles;  ///< file to replay instead of each trial, as typed
  std::optional<bio::discover::Repaired> repaired;
  int shown = 0;  ///< index of the trial that `sizes` refer to, a held-out one if there is one
  std::vector<bio::discover::EffectSize> sizes;  ///< of Verdict::effects
  std::vector<std::pair<std::string, std::string>>
      commands;  ///< quantity, and the command that reproduces it
};

/// The files that writeDiscovery may write.
std::vector<std::string> namesOfDiscovery(std::size_t training, std::size_t heldOut);

/// The findings of a search with their inputs.
struct ModelDiscoveryResult {
  const ModelDiscoveryRequest& request;
  const std::vector<std::string>& files;  ///< of all trials, held-out ones last
  const bio::discover::MusculoskeletalProblem& data;
  const info::discover::Verdict& verdict;
  const std::vector<int>& heldOut;
};

/// Writes with_effect.osim (or refitted.osim if no effect is missing), effect_only.osim and, if the
/// effect concerns the EMG, the sensor or a switched-off muscle, the corrected trials driven_N.sto
/// and driven_held_out_N.sto. The results are the same without a folder.
/// @param summary its inputs are the provenance written into the model
WrittenDiscovery writeDiscovery(const ModelDiscoveryResult& found, Summary& summary,
                                OutputFolder& folder);

}  // namespace app
