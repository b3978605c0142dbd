#include "check/recording_contents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bio/tables/recorded_file.h"
#include "output/text.h"

namespace app {
namespace {

void addMarkers(const bio::MarkerTrajectories& markers, RecordingContents& out) {
  out.summary["markers"] = markers.names;
  if (markers.names.empty()) return;
  const Eigen::Index frames = markers.times.size();
  out.summary["frames"] = frames;
  out.summary["frame_rate_Hz"] = markers.rate;
  out.parts.emplace_back(Paragraph{
      fmt::format("{} markers in {} frames from {} s to {} s.", markers.names.size(), frames,
                  numberText(markers.times[0]), numberText(markers.times[frames - 1]))});
  out.lines.push_back(fmt::format("{} markers in {} frames at {} Hz: {}", markers.names.size(), frames,
                                  numberText(markers.rate, 7), fmt::join(markers.names, ", ")));
  Table table{"Markers", {"marker", "not seen", "first place [m]"}, {}};
  for (std::size_t k = 0; k < markers.names.size(); ++k) {
    const Eigen::MatrixX3d places = positionsOf(markers, markers.names[k]);
    const Eigen::Index missing = places.col(0).array().isNaN().count();
    std::string first = "–";
    for (Eigen::Index i = 0; i < frames && first == "–"; ++i) {
      if (std::isnan(places(i, 0))) continue;
      first = fmt::format("{} {} {}", numberText(places(i, 0)), numberText(places(i, 1)),
                          numberText(places(i, 2)));
    }
    table.rows.push_back({markers.names[k], std::to_string(missing), first});
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

/// One line for all channels of a rate and a unit.
void listChannels(const std::vector<bio::Channel>& channels, RecordingContents& out) {
  constexpr std::size_t most = 12;  // names in a line
  std::map<std::pair<double, std::string>, std::vector<std::string>> kinds;
  for (const bio::Channel& channel : channels)
    kinds[{channel.rate, channel.unit}].push_back(channel.name);
  for (const auto& [kind, names] : kinds) {
    const std::vector<std::string> shown(names.begin(),
                                         names.begin() + static_cast<std::ptrdiff_t>(
                                                             std::min(most, names.size())));
    out.lines.push_back(fmt::format(
        "{} channel{} at {} Hz{}: {}{}", names.size(), names.size() == 1 ? "" : "s",
        numberText(kind.first, 7), kind.second.empty() ? ", no unit" : " in " + kind.second,
        fmt::join(shown, ", "),
        names.size() > most ? fmt::format(" and {} more", names.size() - most) : ""));
  }
}

}  // namespace

RecordingContents recordingContents(const std::string& file) {
  RecordingContents out;
  out.summary["file"] = file;
  out.parts.emplace_back(Section{file});
  Table channels{"Channels",
                 {"channel", "unit", "rate [Hz]", "start [s]", "samples", "smallest", "largest",
                  "not measured"},
                 {}};
  const bio::RecordedFile recorded = bio::readRecordedFile(file);
  out.remarks = recorded.remarks;
  out.warnings = recorded.warnings;
  if (recorded.markers) addMarkers(*recorded.markers, out);
  addChannels(recorded.channels, out, channels);
  listChannels(recorded.channels, out);
  if (!channels.rows.empty()) out.parts.emplace_back(std::move(channels));
  return out;
}

}  // namespace app
