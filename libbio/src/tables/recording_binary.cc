#include <cmath>

#include "bio/tables/c3d_file.h"
#include "bio/tables/xdf_file.h"
#include "tables/recording_layouts.h"

namespace bio {
namespace {

void append(std::vector<Channel>& channels, std::vector<RawColumn>& out) {
  for (Channel& channel : channels) {
    RawColumn column;
    column.number = static_cast<int>(out.size()) + 1;
    column.header = std::move(channel.name);
    column.unit = plainUnit(channel.unit);
    column.rate = channel.rate;
    column.startTime = channel.startTime;
    column.values = std::move(channel.values);
    out.push_back(std::move(column));
  }
}

}  // namespace

void cutEnds(Channel& channel) {
  Eigen::Index first = 0, end = channel.values.size();
  while (first < end && !std::isfinite(channel.values[first])) ++first;
  while (end > first && !std::isfinite(channel.values[end - 1])) --end;
  channel.startTime += static_cast<double>(first) / channel.rate;
  channel.values = channel.values.segment(first, end - first).eval();
}

std::vector<RawColumn> readC3dColumns(const std::string& file, std::vector<std::string>& remarks) {
  C3dFile c3d = readC3d(file);
  remarks.insert(remarks.end(), c3d.remarks.begin(), c3d.remarks.end());
  std::vector<RawColumn> out;
  append(c3d.analog, out);
  return out;
}

std::vector<RawColumn> readXdfColumns(const std::string& file, std::vector<std::string>& remarks) {
  XdfFile xdf = readXdf(file);
  remarks.insert(remarks.end(), xdf.remarks.begin(), xdf.remarks.end());
  std::vector<RawColumn> out;
  for (XdfStream& stream : xdf.streams) append(stream.channels, out);
  return out;
}

}  // namespace bio
