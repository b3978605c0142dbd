#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report.h"

namespace app {

/// Contents of a file of recorded markers or signals.
struct RecordingContents {
  std::vector<ReportPart> parts;
  nlohmann::ordered_json summary;
  std::vector<std::string> lines;     ///< for the terminal: one for each kind of channel, and markers
  std::vector<std::string> remarks;   ///< what was left out, assumed, or looks odd
  std::vector<std::string> warnings;  ///< where the file contradicts itself
};

/// @throws what bio::readRecordedFile throws
RecordingContents recordingContents(const std::string& file);

}  // namespace app
