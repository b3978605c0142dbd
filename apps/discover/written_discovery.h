#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/discovery/workflow.h"
#include "discover/discover_verdict.h"
#include "discover/model_discovery.h"
#include "output/output_folder.h"
#include "output/summary.h"
#include "report/report.h"

namespace app {

/// The model, trials and commands that a search writes beside verdict and report, and their
/// replays.
struct WrittenDiscovery {
  std::string model;  ///< file name of the model with all fitted parameters; empty: none
  std::vector<bio::discover::RepairedTrial> trials;
  std::vector<std::string> replayFiles;  ///< file to replay instead of each trial, as typed
  int shown = 0;  ///< index of the trial that `sizes` refer to, a held-out one if there is one
  std::vector<bio::discover::EffectSize> sizes;                ///< of Verdict::effects
  bio::discover::InputAgreement inputs;                        ///< as DiscoveryResult
  std::optional<info::discover::PositionBreak> positionBreak;  ///< as DiscoveryResult
  bool trialsAreCut = false;
  std::vector<std::pair<std::string, std::string>>
      commands;  ///< quantity, and the command that reproduces it
};

/// The files that writeDiscovery may write.
std::vector<std::string> namesOfDiscovery(std::size_t training, std::size_t heldOut);

/// The result of a search with what was asked.
struct DiscoveryToWrite {
  const ModelDiscoveryRequest& request;
  const std::vector<std::string>& files;  ///< of all trials, held-out ones last
  const DiscoverWording& wording;
  bio::discover::DiscoveryResult& result;  ///< its repaired model gets the starts of driven_N.sto
};

/// Writes with_effect.osim (or closest_match.osim if its effects are not the missing one,
/// refitted.osim if no effect is missing), effect_only.osim and, if the
/// effect concerns the EMG, the sensor or a switched-off muscle, or if the trials were cut, the
/// corrected or cut trials driven_N.sto and driven_held_out_N.sto. The results are the same without
/// a folder.
WrittenDiscovery writeDiscovery(const DiscoveryToWrite& discovery, Summary& summary,
                                OutputFolder& folder);

/// The trials in three dimensions, held-out ones first: with all that was fitted, with the original
/// model, and as measured.
/// @param model  the original one
std::optional<Playback> discoverPlayback(const DiscoveryToWrite& discovery,
                                         const WrittenDiscovery& written, const bio::Model& model);

}  // namespace app
