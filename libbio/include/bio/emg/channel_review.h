#pragma once

#include <string>
#include <vector>

#include "bio/tables/recording.h"

namespace bio {

/// Presumed kind of a channel.
enum class ChannelUse {
  rawEmg,
  envelope,  ///< of an EMG
  measured   ///< a slow signal such as an angle or a torque
};

struct ReviewedChannel {
  const Channel* channel = nullptr;
  ChannelUse use = ChannelUse::rawEmg;
};

/// Sentences on channels that look
///   dead           fewer than 4 different values; raw EMG: an RMS below 1 % of the median of the
///                  others with the same unit
///   clipped        more than 0.1 % of the samples lie in runs of 3 or more at the largest or at
///   the
///                  smallest value (16 or more different values); a measured channel enters and
///                  leaves these runs by 5 times its resolution or more, else it has come to rest
///   smoothed       raw EMG with 95 % of its power below 20 Hz, or never negative
///   low-passed     half of the power of its second differences lies below 0.6 of where it lies for
///                  white noise (0.39 of the rate; raw EMG: below 150 Hz): neighbouring samples do
///                  not have independent noise
///   swapped        a raw EMG without, and a measured channel with most of its power above 20 Hz
///   doubled        two electrodes with |correlation| > 0.999
/// and what follows for the results. Gaps are bridged.
std::vector<std::string> reviewChannels(const std::vector<ReviewedChannel>& channels);

}  // namespace bio
