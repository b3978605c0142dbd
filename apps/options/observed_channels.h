#pragma once

#include <string>
#include <vector>

#include "bio/analysis/sensitivity_study.h"

<<<<<<< HEAD:apps/options/observed_channels.h
    /// The channels that `sensitivity` and `design` observe.
=======
    /// Channels that `sensitivity` observes.
>>>>>>> h4:apps/sensitivity/observed_channels.h
    namespace app {
  /// Channels with the standard deviations of their noise.
  /// @param typed  NAME=SD each, as --observe takes them
  /// @throws what bio::observedChannels throws; std::invalid_argument for text of another kind
  std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                  const bio::Model& model,
                                                  const bio::MusculoskeletalSystem& system);

  /// "ankle_angle.moment (noise 0.5 N·m), …"; empty for none.
  std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model);

}  // namespace app
