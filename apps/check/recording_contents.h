#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report.h"

namespace app {

/// What a file of recorded markers or signals holds.
struct RecordingContents {
  std::vector<ReportPart> parts;
  nlohmann::ordered_json summary;
  std::vector<std::string> remarks;  ///< what was left out, assumed, or looks odd
};

/// Whether the name says C3D, XDF or TRC.
bool isRecordedFile(const std::string& file);

/// @throws bio::FileError as the readers
RecordingContents recordingContents(const std::string& file);

}  // namespace app
