#include "bio/tables/recorded_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "bio/tables/c3d_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/xdf_file.h"
#include "tables/cells.h"

namespace bio {
namespace {

std::string extensionOf(const std::string& file) {
  return tables::lowered(std::filesystem::path(file).extension().string());
}

void addRemarks(const std::vector<std::string>& more, std::vector<std::string>& remarks) {
  remarks.insert(remarks.end(), more.begin(), more.end());
}

void takeMarkers(MarkerTrajectories markers, RecordedFile& out) {
  std::vector<std::string> unseen;
  for (const std::string& name : markers.names) {
    if (positionsOf(markers, name).col(0).array().isNaN().all()) unseen.push_back(name);
  }
  if (!unseen.empty()) {
    out.remarks.push_back(fmt::format("{} of {} markers are never seen: {}", unseen.size(),
                                      markers.names.size(), fmt::join(unseen, ", ")));
  }
  out.markers = std::move(markers);
}

}  // namespace

bool isRecordedFile(const std::string& file) {
  const std::string extension = extensionOf(file);
  if (extension == ".c3d" || extension == ".xdf" || extension == ".trc") return true;
  if (extension == ".edf" || extension == ".bdf") return true;
  if (extension == ".sto" || extension == ".mot" || extension == ".osim") return false;
  try {
    const RecordingFormat format = detectFormat(file);
    return format != RecordingFormat::table && format != RecordingFormat::columns;
  } catch (const FileError&) {
    return false;
  }
}

RecordedFile readRecordedFile(const std::string& file) {
  const std::string extension = extensionOf(file);
  RecordedFile out;
  if (extension == ".trc") {
    MarkerTrajectories markers = readTrc(file);
    addRemarks(markers.remarks, out.warnings);  // where names, counts and rows contradict
    takeMarkers(std::move(markers), out);
  } else if (extension == ".c3d") {
    C3dFile c3d = readC3d(file);
    addRemarks(c3d.remarks, out.remarks);
    addRemarks(c3d.warnings, out.warnings);
    addRemarks(c3d.markers.remarks, out.remarks);
    takeMarkers(std::move(c3d.markers), out);
    out.channels = std::move(c3d.analog);
  } else if (extension == ".xdf") {
    XdfFile xdf = readXdf(file);
    addRemarks(xdf.remarks, out.remarks);
    addRemarks(xdf.warnings, out.warnings);
    for (XdfStream& stream : xdf.streams)
      for (Channel& channel : stream.channels) out.channels.push_back(std::move(channel));
  } else {
    Recording recording = readRecording(file);
    addRemarks(recording.remarks, out.remarks);
    addRemarks(recording.warnings, out.warnings);
    out.channels = std::move(recording.channels);
  }
  return out;
}

}  // namespace bio
