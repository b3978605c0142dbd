#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/emg/alignment.h"
#include "bio/emg/emg_config.h"

namespace bio {

/// Recordings of one movement with the times of the first.
struct JoinedRecordings {
  /// Where one behind the first was placed.
  struct Placed {
    std::string file;
    double offset = 0;               ///< time of the first = its own + offset [s]
    std::optional<Alignment> found;  ///< absent: the offset was given
  };
  Recording recording;  ///< all channels, at their own rates
  std::vector<Placed> placed;
};

/// Reads the recordings of one movement: the first as the configuration says, each further one as
/// its [[recording]] says.
/// @throws FileError as readRecording, and for other than one [[recording]] per further file, two
///   channels of one name, a channel to align that is not there, or what alignmentOf refuses
JoinedRecordings readRecordings(const EmgConfigFile& config, const std::vector<std::string>& files);

}  // namespace bio
