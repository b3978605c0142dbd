#include "bio/tables/xdf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tables/cells.h"
#include "tables/formats/xdf_chunks.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using tables::Bytes;
using tables::RawXdfStream;

constexpr std::size_t mostRestarts = 100;
constexpr double leastClockJump = 1;  // [s], that no drift between two measurements explains

// Straight line through points (x, y): y = mean + slope·(x − centre).
struct Line {
  double centre = 0, mean = 0, slope = 0;
  double at(double x) const { return mean + slope * (x - centre); }
};

template <class X, class Y>
Line lineThrough(std::size_t count, X x, Y y) {
  Line line;
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    line.centre += x(i) / n;
    line.mean += y(i) / n;
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < count; ++i) {
    xx += (x(i) - line.centre) * (x(i) - line.centre);
    xy += (x(i) - line.centre) * (y(i) - line.mean);
  }
  line.slope = xx > 0 ? xy / xx : 0;
  return line;
}

// Offsets and samples between two restarts of a stream's clock.
struct XdfClock {
  std::size_t firstOffset = 0, endOffset = 0;
  std::size_t firstSample = 0, endSample = 0;
};

// Where the stamps leap against a leap of the offsets by `jump` [s], near the samples that stand
// before and behind it in the file.
std::size_t restartIn(const Bytes& bytes, const RawXdfStream& stream, std::size_t from,
                      std::size_t to, double jump) {
  std::size_t best = 0;
  double largest = leastClockJump / 2;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < to; ++i) {
    const double step = stream.stamps[i] - stream.stamps[i - 1];
    if ((step > 0) == (jump > 0) || std::abs(step) <= largest) continue;
    largest = std::abs(step);
    best = i;
  }
  if (best == 0) {
    bytes.fail(
        fmt::format("stream '{}': the offset of its clock leaps by {:.6g} s where its time "
                    "stamps do not, must leap with them",
                    stream.name, jump));
  }
  return best;
}

// A clock that was set or restarted gives offsets that leap by more than any drift.
std::vector<XdfClock> clocksOf(const Bytes& bytes, const RawXdfStream& stream) {
  const auto& offsets = stream.offsets;
  std::vector<XdfClock> clocks = {{0, offsets.size(), 0, stream.stamps.size()}};
  for (std::size_t k = 1; k < offsets.size(); ++k) {
    const double jump = offsets[k].by - offsets[k - 1].by;
    if (std::abs(jump) < leastClockJump) continue;
    // a single measurement that its neighbours contradict was delayed: it is scatter, no restart
    const bool isStray =
        k + 1 < offsets.size() && std::abs(offsets[k + 1].by - offsets[k - 1].by) < leastClockJump;
    if (isStray) {
      ++k;
      continue;
    }
    // the file's order of samples and offsets is not exact: one offset more at both sides
    std::size_t from = clocks.back().firstSample, to = stream.stamps.size();
    for (std::size_t i = 0; i < k; ++i) {
      if (offsets[i].samples < offsets[k - 1].samples) from = std::max(from, offsets[i].samples);
    }
    for (std::size_t i = offsets.size(); i-- > k;) {
      if (offsets[i].samples > offsets[k].samples) to = offsets[i].samples;
    }
    const std::size_t at = restartIn(bytes, stream, from, to, jump);
    if (clocks.size() > mostRestarts) {
      bytes.fail(fmt::format("stream '{}': the offset of its clock leaps more than {} times",
                             stream.name, mostRestarts));
    }
    clocks.back().endOffset = k;
    clocks.back().endSample = at;
    clocks.push_back({k, offsets.size(), at, stream.stamps.size()});
  }
  return clocks;
}

// Brings the stamps to the recorder's clock.
void synchronise(const Bytes& bytes, RawXdfStream& stream, std::vector<std::string>& remarks) {
  if (stream.offsets.empty()) return;
  double scatter = 0;
  const std::vector<XdfClock> clocks = clocksOf(bytes, stream);
  for (const XdfClock& clock : clocks) {
    const auto at = [&](std::size_t i) { return stream.offsets[clock.firstOffset + i].at; };
    const auto by = [&](std::size_t i) { return stream.offsets[clock.firstOffset + i].by; };
    const std::size_t count = clock.endOffset - clock.firstOffset;
    const Line line = lineThrough(count, at, by);
    if (!(std::abs(line.slope) < 0.01)) {
      bytes.fail(
          fmt::format("stream '{}': its clock runs off by {:.3g} s per second, must be below "
                      "0.01",
                      stream.name, line.slope));
    }
    for (std::size_t i = 0; i < count; ++i) {
      scatter = std::max(scatter, std::abs(by(i) - line.at(at(i))));
    }
    for (std::size_t i = clock.firstSample; i < clock.endSample; ++i) {
      stream.stamps[i] += line.at(stream.stamps[i]);
    }
  }
  for (std::size_t c = 1; c < clocks.size(); ++c) stream.restarts.push_back(clocks[c].firstSample);
  if (clocks.size() > 1) {
    remarks.push_back(fmt::format(
        "Stream '{}': its clock was set or restarted {} time{}; each part was brought to the "
        "recorder's clock by its own offsets.",
        stream.name, clocks.size() - 1, clocks.size() > 2 ? "s" : ""));
  }
  if (scatter > 0.01) {
    remarks.push_back(
        fmt::format("Stream '{}': measured offsets of its clock are up to {:.3g} ms "
                    "off a straight line.",
                    stream.name, 1000 * scatter));
  }
}

// Samples without a leap of their stamps between them.
struct XdfSegment {
  std::size_t first = 0, count = 0;
  double start = 0;     // [s]
  double interval = 0;  // [s]
  bool anyBackward = false;
};

double middleOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The straight line through stamps of which some run backwards: those over 6 standard deviations
// off the one through medians do not count.
Line lineWithoutStrays(const double* stamps, std::size_t count) {
  const auto number = [](std::size_t i) { return static_cast<double>(i); };
  const std::size_t half = count / 2;
  std::vector<double> slopes, rest;
  for (std::size_t i = 0; i + half < count; ++i) {
    slopes.push_back((stamps[i + half] - stamps[i]) / number(half));
  }
  const double slope = middleOf(slopes);
  for (std::size_t i = 0; i < count; ++i) rest.push_back(stamps[i] - slope * number(i));
  const double level = middleOf(rest);
  for (double& off : rest) off = std::abs(off - level);
  const double most = 6 * 1.4826 * middleOf(rest) + 1e-9;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < count; ++i) {
    if (rest[i] <= most) kept.push_back(i);
  }
  return lineThrough(
      kept.size(), [&](std::size_t k) { return number(kept[k]); },
      [&](std::size_t k) { return stamps[kept[k]]; });
}

// Stamps that run backwards, and by how much at most.
struct BackwardStamps {
  std::size_t count = 0, first = 0;
  double most = 0;  // [s]
};

void tellBackward(const RawXdfStream& stream, const BackwardStamps& backward,
                  std::vector<std::string>& warnings) {
  if (backward.count == 0) return;
  warnings.push_back(fmt::format(
      "Stream '{}': its time stamps run backwards {} time{}, first at sample {} ({:.6f} s after "
      "{:.6f} s), by at most {:.3g} ms; its rate is that of a straight line that such stamps do "
      "not "
      "pull.",
      stream.name, backward.count, backward.count == 1 ? "" : "s", backward.first + 1,
      stream.stamps[backward.first], stream.stamps[backward.first - 1], 1e3 * backward.most));
}

std::vector<XdfSegment> segmentsOf(const Bytes& bytes, const RawXdfStream& stream,
                                   std::vector<std::string>& warnings) {
  const double leap = std::max(1.0, 500 / stream.nominalRate);
  std::vector<XdfSegment> out;
  BackwardStamps backward;
  for (std::size_t i = 0; i < stream.stamps.size(); ++i) {
    const double step = i == 0 ? 0 : stream.stamps[i] - stream.stamps[i - 1];
    if (step < -leap) {
      bytes.fail(fmt::format("stream '{}': time stamp {:.6f} s after {:.6f} s, must not go back",
                             stream.name, stream.stamps[i], stream.stamps[i - 1]));
    }
    const bool restarts =
        std::find(stream.restarts.begin(), stream.restarts.end(), i) != stream.restarts.end();
    if (i == 0 || step > leap || restarts) {
      out.push_back({.first = i});
    } else if (step < 0) {
      if (backward.count++ == 0) backward.first = i;
      backward.most = std::max(backward.most, -step);
      out.back().anyBackward = true;
    }
    ++out.back().count;
  }
  for (XdfSegment& segment : out) {
    const double* stamps = stream.stamps.data() + segment.first;
    const Line line = segment.anyBackward && segment.count >= 20
                          ? lineWithoutStrays(stamps, segment.count)
                          : lineThrough(
                                segment.count, [](std::size_t i) { return static_cast<double>(i); },
                                [&](std::size_t i) { return stamps[i]; });
    segment.start = line.at(0);
    segment.interval = line.slope;
  }
  tellBackward(stream, backward, warnings);
  return out;
}

// Effective rate of all segments together.
double rateOfStream(const Bytes& bytes, const RawXdfStream& stream,
                    const std::vector<XdfSegment>& segments) {
  double intervals = 0, duration = 0;
  for (const XdfSegment& segment : segments) {
    const auto n = static_cast<double>(segment.count - 1);
    intervals += n;
    duration += n * segment.interval;
  }
  const double rate = intervals / duration;
  if (!(rate > 0 && rate < 1e9)) {
    bytes.fail(fmt::format("stream '{}': its time stamps do not rise, must rise by about {:g} s",
                           stream.name, 1 / stream.nominalRate));
  }
  return rate;
}

std::string channelName(const RawXdfStream& stream, std::size_t c) {
  if (c < stream.labels.size() && !stream.labels[c].empty()) {
    return stream.name + " " + stream.labels[c];
  }
  return stream.channels == 1 ? stream.name : fmt::format("{} {}", stream.name, c + 1);
}

XdfStream streamOf(const Bytes& bytes, const RawXdfStream& raw, std::vector<std::string>& remarks,
                   std::vector<std::string>& warnings) {
  const std::vector<XdfSegment> segments = segmentsOf(bytes, raw, warnings);
  const double rate = rateOfStream(bytes, raw, segments);
  const double off = std::abs(rate / raw.nominalRate - 1);
  if (!(off < 0.005)) {
    (off < 0.05 ? remarks : warnings)
        .push_back(fmt::format("Stream '{}': {:.6g} Hz by its time stamps, {:g} Hz by its "
                               "header; the stamps were used.",
                               raw.name, rate, raw.nominalRate));
  }
  // row of each segment's first sample; missing samples between them
  std::vector<Eigen::Index> rows;
  Eigen::Index end = 0;
  for (const XdfSegment& segment : segments) {
    const double place = std::round((segment.start - segments.front().start) * rate);
    const double most = 2 * static_cast<double>(raw.stamps.size()) + 1000;
    if (!(place <= most)) {
      bytes.fail(
          fmt::format("stream '{}': no samples for {:.3g} s, must be missing for at most as "
                      "long as it has them",
                      raw.name, (place - static_cast<double>(end)) / rate));
    }
    rows.push_back(std::max(end, static_cast<Eigen::Index>(std::max(place, 0.0))));
    end = rows.back() + static_cast<Eigen::Index>(segment.count);
  }
  if (segments.size() > 1) {
    remarks.push_back(fmt::format("Stream '{}': {} times samples are missing, {} in all.", raw.name,
                                  segments.size() - 1,
                                  end - static_cast<Eigen::Index>(raw.stamps.size())));
  }
  XdfStream out{raw.name, raw.type, {}};
  for (std::size_t c = 0; c < raw.channels; ++c) {
    Channel channel;
    channel.name = channelName(raw, c);
    channel.writtenUnit = c < raw.units.size() ? tables::inUtf8(raw.units[c]) : "";
    channel.unit = plainUnit(channel.writtenUnit);
    channel.nominalRate = raw.nominalRate;
    channel.rate = rate;
    channel.startTime = segments.front().start;
    channel.values.setConstant(end, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t s = 0; s < segments.size(); ++s) {
      for (std::size_t i = 0; i < segments[s].count; ++i) {
        const double value = raw.values[(segments[s].first + i) * raw.channels + c];
        if (!std::isfinite(value)) continue;
        channel.values[rows[s] + static_cast<Eigen::Index>(i)] = value;
      }
    }
    out.channels.push_back(std::move(channel));
  }
  return out;
}

// Why a stream gives no channels; empty if it does.
std::string whyLeftOut(const RawXdfStream& stream) {
  if (stream.width == 0) return "holds texts";
  if (stream.nominalRate == 0) return "has no steady rate";
  if (stream.stamps.size() < 2) {
    return fmt::format("has {} sample{}", stream.stamps.size(), stream.stamps.empty() ? "s" : "");
  }
  return "";
}

}  // namespace

XdfFile readXdf(const std::filesystem::path& file) {
  return xdfFrom(readTextFile(file), file.string());
}

XdfFile xdfFrom(std::string_view content, const std::string& name) {
  const Bytes bytes(name, content);
  tables::RawXdf raw = tables::readXdfChunks(bytes);
  XdfFile out;
  if (raw.unread > 0) {
    out.remarks.push_back(
        fmt::format("The recording was cut off: its last {} of {} bytes were not read.", raw.unread,
                    bytes.size()));
  }
  double earliest = std::numeric_limits<double>::infinity();
  for (RawXdfStream& stream : raw.streams) {
    if (const std::string why = whyLeftOut(stream); !why.empty()) {
      out.remarks.push_back(fmt::format("Stream '{}' {} and was not read.", stream.name, why));
      continue;
    }
    synchronise(bytes, stream, out.remarks);
    out.streams.push_back(streamOf(bytes, stream, out.remarks, out.warnings));
    earliest = std::min(earliest, out.streams.back().channels.front().startTime);
  }
  for (XdfStream& stream : out.streams) {
    for (Channel& channel : stream.channels) {
      channel.startTime -= earliest;
      cutEnds(channel);
    }
  }
  return out;
}

}  // namespace bio
