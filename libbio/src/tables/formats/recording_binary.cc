#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "bio/tables/c3d_file.h"
#include "bio/tables/edf_file.h"
#include "bio/tables/marker_trajectories.h"
#include "bio/tables/xdf_file.h"
#include "tables/recording_layouts.h"

namespace bio {
namespace {

void append(std::vector<Channel>& channels, std::vector<RawColumn>& out) {
  for (Channel& channel : channels) {
    RawColumn column;
    column.number = static_cast<int>(out.size()) + 1;
    column.header = std::move(channel.name);
    column.unit = channel.writtenUnit.empty() ? channel.unit : channel.writtenUnit;
    column.rate = channel.rate;
    column.startTime = channel.startTime;
    column.nominalRate = channel.nominalRate;
    column.values = std::move(channel.values);
    out.push_back(std::move(column));
  }
}

void add(const std::vector<std::string>& remarks, const std::vector<std::string>& warnings,
         ReadingNotes& notes) {
  notes.remarks.insert(notes.remarks.end(), remarks.begin(), remarks.end());
  notes.warnings.insert(notes.warnings.end(), warnings.begin(), warnings.end());
}

// Three columns of every point that was seen.
void appendPoints(const MarkerTrajectories& markers, ReadingNotes& notes,
                  std::vector<RawColumn>& out) {
  std::vector<std::string>& remarks = notes.remarks;
  remarks.insert(remarks.end(), markers.remarks.begin(), markers.remarks.end());
  std::vector<Channel> channels;
  std::vector<std::string> unseen;
  for (std::size_t k = 0; k < markers.names.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(3 * k);
    constexpr std::array<const char*, 3> endings = {".x", ".y", ".z"};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Channel channel{markers.names[k] + endings[static_cast<std::size_t>(axis)], "m", markers.rate,
                      markers.times[0], markers.positions.col(first + axis)};
      cutEnds(channel);
      if (channel.values.size() > 1) channels.push_back(std::move(channel));
    }
    if (channels.empty() || channels.back().name != markers.names[k] + ".z") {
      unseen.push_back(markers.names[k]);
    }
  }
  if (!unseen.empty()) {
    remarks.push_back(
        fmt::format("{} of {} points were never seen, or once, and were not read: {}.",
                    unseen.size(), markers.names.size(), fmt::join(unseen, ", ")));
  }
  append(channels, out);
}

}  // namespace

void cutEnds(Channel& channel) {
  Eigen::Index first = 0, end = channel.values.size();
  while (first < end && !std::isfinite(channel.values[first])) ++first;
  while (end > first && !std::isfinite(channel.values[end - 1])) --end;
  channel.startTime += static_cast<double>(first) / channel.rate;
  channel.values = channel.values.segment(first, end - first).eval();
}

std::vector<RawColumn> readC3dColumns(const std::string& file, ReadingNotes& notes) {
  C3dFile c3d = readC3d(file);
  add(c3d.remarks, c3d.warnings, notes);
  std::vector<RawColumn> out;
  append(c3d.analog, out);
  appendPoints(c3d.markers, notes, out);
  return out;
}

std::vector<RawColumn> readEdfColumns(const std::string& file, ReadingNotes& notes) {
  EdfFile edf = readEdf(file);
  add(edf.remarks, edf.warnings, notes);
  std::vector<RawColumn> out;
  append(edf.channels, out);
  return out;
}

std::vector<RawColumn> readTrcColumns(const std::string& file, ReadingNotes& notes) {
  MarkerTrajectories markers = readTrc(file);
  notes.warnings = std::move(markers.remarks);  // where names, counts and rows contradict
  markers.remarks.clear();
  std::vector<RawColumn> out;
  appendPoints(markers, notes, out);
  return out;
}

std::vector<RawColumn> readXdfColumns(const std::string& file, ReadingNotes& notes) {
  XdfFile xdf = readXdf(file);
  add(xdf.remarks, xdf.warnings, notes);
  std::vector<RawColumn> out;
  for (XdfStream& stream : xdf.streams) append(stream.channels, out);
  return out;
}

}  // namespace bio
