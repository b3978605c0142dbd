#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bio/tables/marker_trajectories.h"
#include "bio/tables/recording.h"

namespace bio {

/// Contents of a file of recorded markers or signals.
struct RecordedFile {
  std::optional<MarkerTrajectories> markers;  ///< none: a format without markers
  std::vector<Channel> channels;              ///< analog channels, or those of all streams
  std::vector<std::string> remarks;           ///< what was left out or assumed, or looks odd
  std::vector<std::string> warnings;          ///< where the file contradicts itself
};

/// Whether the name says C3D, XDF, TRC, EDF or BDF, or, for any other name than .sto, .mot and
/// .osim, the content an export of a recording system (detectFormat).
bool isRecordedFile(const std::string& file);

/// Reads a file of one of these formats by its name (readC3d, readXdf, readTrc), any other as
/// readRecording does without a declaration.
/// @throws FileError as they do
RecordedFile readRecordedFile(const std::string& file);

}  // namespace bio
