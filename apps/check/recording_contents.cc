#include "check/recording_contents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "bio/tables/c3d_file.h"
#include "bio/tables/marker_trajectories.h"
#include "bio/tables/xdf_file.h"
#include "output/text.h"

namespace app {
namespace {

std::string extensionOf(const std::string& file) {
  std::string out = std::filesystem::path(file).extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

void addRemarks(const std::vector<std::string>& more, RecordingContents& out) {
  out.remarks.insert(out.remarks.end(), more.begin(), more.end());
}

void addMarkers(const bio::MarkerTrajectories& markers, RecordingContents& out) {
  addRemarks(markers.remarks, out);
  out.summary["markers"] = markers.names;
  if (markers.names.empty()) return;
  const Eigen::Index frames = markers.times.size();
  out.summary["frames"] = frames;
  out.summary["frame_rate_Hz"] = markers.rate;
  out.parts.emplace_back(Paragraph{
      fmt::format("{} markers in {} frames from {} s to {} s.", markers.names.size(), frames,
                  numberText(markers.times[0]), numberText(markers.times[frames - 1]))});
  Table table{"Markers", {"marker", "not seen", "first place [m]"}, {}};
  std::vector<std::string> unseen;
  for (std::size_t k = 0; k < markers.names.size(); ++k) {
    const Eigen::MatrixX3d places = positionsOf(markers, markers.names[k]);
    const Eigen::Index missing = places.col(0).array().isNaN().count();
    std::string first = "–";
    for (Eigen::Index i = 0; i < frames && first == "–"; ++i) {
      if (std::isnan(places(i, 0))) continue;
      first = fmt::format("{} {} {}", numberText(places(i, 0)), numberText(places(i, 1)),
                          numberText(places(i, 2)));
    }
    if (missing == frames) unseen.push_back(markers.names[k]);
    table.rows.push_back({markers.names[k], std::to_string(missing), first});
  }
  if (!unseen.empty()) {
    out.remarks.push_back(fmt::format("{} of {} markers are never seen: {}", unseen.size(),
                                      markers.names.size(), fmt::join(unseen, ", ")));
  }
  out.parts.emplace_back(std::move(table));
}

void addChannels(const std::vector<bio::Channel>& channels, RecordingContents& out, Table& table) {
  for (const bio::Channel& channel : channels) {
    const Eigen::VectorXd& values = channel.values;
    const bool any = values.size() > 0;
    table.rows.push_back({channel.name, channel.unit, numberText(channel.rate),
                          numberText(channel.startTime), std::to_string(values.size()),
                          any ? numberText(values.minCoeff<Eigen::PropagateNumbers>()) : "",
                          any ? numberText(values.maxCoeff<Eigen::PropagateNumbers>()) : "",
                          std::to_string(values.array().isNaN().count())});
    out.summary["channels"].push_back(
        {{"name", channel.name}, {"unit", channel.unit}, {"rate_Hz", channel.rate}});
  }
}

}  // namespace

bool isRecordedFile(const std::string& file) {
  const std::string extension = extensionOf(file);
  return extension == ".c3d" || extension == ".xdf" || extension == ".trc";
}

RecordingContents recordingContents(const std::string& file) {
  RecordingContents out;
  out.summary["file"] = file;
  out.parts.emplace_back(Section{file});
  Table channels{"Channels",
                 {"channel", "unit", "rate [Hz]", "start [s]", "samples", "smallest", "largest",
                  "not measured"},
                 {}};
  const std::string extension = extensionOf(file);
  if (extension == ".trc") {
    addMarkers(bio::readTrc(file), out);
  } else if (extension == ".c3d") {
    const bio::C3dFile c3d = bio::readC3d(file);
    addRemarks(c3d.remarks, out);
    addMarkers(c3d.markers, out);
    addChannels(c3d.analog, out, channels);
  } else {
    const bio::XdfFile xdf = bio::readXdf(file);
    addRemarks(xdf.remarks, out);
    for (const bio::XdfStream& stream : xdf.streams) addChannels(stream.channels, out, channels);
  }
  if (!channels.rows.empty()) out.parts.emplace_back(std::move(channels));
  return out;
}

}  // namespace app
