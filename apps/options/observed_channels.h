#pragma once

#include <string>
#include <vector>

#include "bio/analysis/sensitivity_study.h"

/// The channels that `sensitivity`, `design` and `ensemble` observe.
namespace app {
/// The names in NAME or NAME=SD, for what needs no noise.
/// @throws std::invalid_argument for an SD that is not a number
std::vector<std::string> namesOf(const std::vector<std::string>& typed);

/// Channels with the standard deviations of their noise.
/// @param typed  NAME=SD each, as --observe takes them
/// @throws what bio::observedChannels throws; std::invalid_argument for text of another kind
std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                const bio::Model& model,
                                                const bio::MusculoskeletalSystem& system);

/// "ankle_angle.moment (noise 0.5 N·m), …"; empty for none.
std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model);

}  // namespace app
