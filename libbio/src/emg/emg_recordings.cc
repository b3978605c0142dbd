#include "bio/emg/emg_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/tables/file_error.h"

namespace bio {
namespace {

// The part of a channel between two times.
Channel partOf(const Channel& channel, double from, double to) {
  const auto size = static_cast<double>(channel.values.size());
  const double first = std::clamp(std::ceil((from - channel.startTime) * channel.rate), 0.0, size);
  const double end = std::clamp(std::floor((to - channel.startTime) * channel.rate), first, size);
  Channel out = channel;
  out.startTime += first / channel.rate;
  out.values = channel.values.segment(static_cast<Eigen::Index>(first),
                                      static_cast<Eigen::Index>(end - first));
  return out;
}

// A sentence if the clocks run apart by more than two samples between the halves.
std::string driftRemark(const Channel& reference, const Channel& other) {
  const double begin = std::max(reference.startTime, other.startTime);
  const double end = std::min(endTime(reference), endTime(other));
  const double middle = (begin + end) / 2, margin = 0.25;
  const double slowest = std::min(reference.rate, other.rate);
  if ((end - begin) * slowest < 100 || end - begin < 8 * margin) return "";
  try {
    const AlignmentOptions near{.within = margin};
    const double first =
        alignmentOf(partOf(reference, begin, middle), partOf(other, begin, middle), near).offset;
    const double second =
        alignmentOf(partOf(reference, middle, end), partOf(other, middle, end), near).offset;
    const double drift = 2 * (second - first);
    if (std::abs(drift) < std::max(2 / slowest, 0.005)) return "";
    return fmt::format("The clocks of '{}' and '{}' run apart by about {:.3g} ms over {:.3g} s.",
                       reference.name, other.name, 1000 * drift, end - begin);
  } catch (const std::invalid_argument&) {
    return "";  // one half shows no event: nothing can be said
  }
}

class Joining {
 public:
  Joining(const EmgConfigFile& config, JoinedRecordings& out) : config_(config), out_(out) {}

  void add(const std::string& file, const FurtherRecording& further) {
    Recording more = readRecording(file, further.layout);
    JoinedRecordings::Placed placed{file, further.offset.value_or(0), std::nullopt};
    if (!further.offset) placed.found = align(more, further);
    if (placed.found) placed.offset = placed.found->offset;
    for (Channel& channel : more.channels) {
      channel.startTime += placed.offset;
      checkName(channel.name, file);
    }
    say(placed, further, more);
    Recording& all = out_.recording;
    all.file += " + " + file;
    std::move(more.channels.begin(), more.channels.end(), std::back_inserter(all.channels));
    std::move(more.remarks.begin(), more.remarks.end(), std::back_inserter(all.remarks));
    std::move(more.warnings.begin(), more.warnings.end(), std::back_inserter(all.warnings));
    out_.placed.push_back(std::move(placed));
  }

 private:
  [[noreturn]] void fail(int line, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", config_.file, line, what));
  }

  Alignment align(const Recording& more, const FurtherRecording& further) const {
    try {
      AlignmentOptions options;
      if (further.within) options.within = *further.within;
      return alignmentOf(findChannel(out_.recording, further.with),
                         findChannel(more, further.match), options);
    } catch (const std::invalid_argument& e) {
      fail(further.line, e.what());
    }
  }

  void checkName(const std::string& name, const std::string& file) const {
    for (const Channel& channel : out_.recording.channels) {
      if (channel.name != name) continue;
      throw FileError(
          fmt::format("{}: channel '{}' is in {}, too, must have another name (name in "
                      "[[recording.channel]])",
                      file, name, out_.recording.file));
    }
  }

  void say(const JoinedRecordings::Placed& placed, const FurtherRecording& further,
           const Recording& more) {
    std::vector<std::string>& remarks = out_.recording.remarks;
    if (!placed.found) {
      remarks.push_back(
          fmt::format("{}: {:g} s were added to its times, as given.", placed.file, placed.offset));
      return;
    }
    const Alignment& found = *placed.found;
    remarks.push_back(fmt::format(
        "{}: {:.4f} s were added to its times: its channel '{}' and '{}' correlate best there (r = "
        "{:.3f}{}, elsewhere {:.3f} at most, {:.3g} s overlap).",
        placed.file, found.offset, further.match, further.with, found.correlation,
        found.correlation < 0 ? ", one is upside down" : "", found.rival, found.overlap));
    const std::string drift =
        driftRemark(findChannel(out_.recording, further.with), findChannel(more, further.match));
    if (!drift.empty()) remarks.push_back(drift);
  }

  const EmgConfigFile& config_;
  JoinedRecordings& out_;
};

}  // namespace

JoinedRecordings readRecordings(const EmgConfigFile& config,
                                const std::vector<std::string>& files) {
  if (files.empty() || files.size() - 1 != config.further.size()) {
    throw FileError(
        fmt::format("{}: {} recordings and {} tables [[recording]], must be one table for each "
                    "recording behind "
                    "the first (offset_s = 0: same clock)",
                    config.file, files.size(), config.further.size()));
  }
  JoinedRecordings out;
  out.recording = readRecording(files.front(), config.layout);
  Joining joining(config, out);
  for (std::size_t i = 1; i < files.size(); ++i) joining.add(files[i], config.further[i - 1]);
  return out;
}

}  // namespace bio
