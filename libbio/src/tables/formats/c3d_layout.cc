#include "tables/formats/c3d_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bio::tables {
namespace {

// A number that header and parameter both tell, and must tell alike.
std::size_t agreed(const Bytes& bytes, const std::vector<double>& parameter, double header,
                   const std::string& name) {
  if (parameter.empty()) return static_cast<std::size_t>(header);
  const double value = parameter.front();
  if (value != header) {
    bytes.fail(
        fmt::format("{} = {:g}, but the header says {:g}, must be equal", name, value, header));
  }
  return static_cast<std::size_t>(value);
}

// A count of frames in two 16-bit words, the lower first, or in one number.
std::optional<double> longCount(const C3dParameters& parameters, const std::string& name) {
  const std::vector<double> words = parameters.numbers(name, true);
  if (words.empty()) return std::nullopt;
  return words.size() > 1 ? words[0] + 65536 * words[1] : words[0];
}

bool isZero(const Bytes& bytes, std::size_t from, std::size_t to) {
  for (std::size_t at = from; at < to; ++at) {
    if (bytes.uintWithin(at, 1) != 0) return false;
  }
  return true;
}

// The frames that the data section holds, where it holds more than `promised`: the header cannot
// count beyond 65535. Blocks are filled up with zeros.
std::size_t framesHeld(const Bytes& bytes, const C3dLayout& layout, std::size_t promised,
                       const std::string& source, ReadingNotes& notes) {
  const std::size_t frame = layout.valuesPerFrame() * layout.width();
  if (frame == 0) bytes.fail("has neither points nor analog channels, must have some");
  // in some files the parameters stand behind the data
  std::size_t end = bytes.size();
  const std::size_t parameters = (bytes.uint8(0, "header") - std::size_t{1}) * c3dBlock;
  if (parameters > layout.data) end = std::min(end, parameters);
  std::size_t held = layout.data < end ? (end - layout.data) / frame : 0;
  if (promised > held) {
    bytes.fail(
        fmt::format("promises {} frames, its data section holds {} (cut off?)", promised, held));
  }
  const auto at = [&](std::size_t f) { return layout.data + f * frame; };
  while (held > promised && isZero(bytes, at(held - 1), at(held))) --held;
  // less than a block behind the last frame is filling
  if (held == promised || end - at(promised) < c3dBlock) return promised;
  notes.warnings.push_back(
      fmt::format("{} tells of {} frames, its data section holds {}: all that it holds were read.",
                  source, promised, held));
  return held;
}

// The first of what counts frames: it is exact beyond 65535, where the header is not.
std::size_t framesOf(const Bytes& bytes, const C3dParameters& parameters, C3dLayout& layout,
                     ReadingNotes& notes) {
  const double first = bytes.uint16(6, "header"), last = bytes.uint16(8, "header");
  layout.firstFrame = first;
  double frames = last - first + 1;
  std::string source = fmt::format("header: frames {:g} to {:g}", first, last);
  const auto actualStart = longCount(parameters, "TRIAL:ACTUAL_START_FIELD");
  const auto actualEnd = longCount(parameters, "TRIAL:ACTUAL_END_FIELD");
  if (actualStart && actualEnd) {
    layout.firstFrame = *actualStart;
    frames = *actualEnd - *actualStart + 1;
    source = fmt::format("TRIAL:ACTUAL_START_FIELD = {:g}, ACTUAL_END_FIELD = {:g}", *actualStart,
                         *actualEnd);
  } else if (const auto count = longCount(parameters, "POINT:LONG_FRAMES")) {
    frames = *count;
    source = fmt::format("POINT:LONG_FRAMES = {:g}", *count);
  }
  if (!(frames >= 1 && frames < 1e15 && std::isfinite(layout.firstFrame))) {
    bytes.fail(fmt::format("{}, must be at least one frame", source));
  }
  if (last < 65535 && frames != last - first + 1) {
    notes.warnings.push_back(fmt::format(
        "{}, but the header says {:g} to {:g}: the header was not used.", source, first, last));
  }
  return framesHeld(bytes, layout, static_cast<std::size_t>(frames), source, notes);
}

double rateIn(const Bytes& bytes, const C3dParameters& parameters, ReadingNotes& notes) {
  const double header = static_cast<double>(bytes.float32(20, "header"));
  const std::vector<double> parameter = parameters.numbers("POINT:RATE");
  const double rate = parameter.empty() ? header : parameter.front();
  if (!(rate > 0 && rate < 1e9)) {
    bytes.fail(fmt::format("POINT:RATE = {:g} Hz, must be > 0", rate));
  }
  if (!(std::abs(header / rate - 1) < 1e-3)) {
    notes.warnings.push_back(
        fmt::format("POINT:RATE = {:g} Hz, but the header says {:g} Hz: the header was not used.",
                    rate, header));
  }
  return rate;
}

// The byte at which the data begin: what the header says; a parameter that contradicts it is told.
std::size_t dataStart(const Bytes& bytes, const C3dParameters& parameters, ReadingNotes& notes) {
  double start = bytes.uint16(16, "header");
  const std::vector<double> stated = parameters.numbers("POINT:DATA_START", true);
  // 0: not stated
  if (!stated.empty() && stated.front() != 0 && stated.front() != start) {
    const bool usesHeader = start >= 2;
    notes.remarks.push_back(
        fmt::format("POINT:DATA_START = {:g}, but the header says {:g}: the {} was used.",
                    stated.front(), start, usesHeader ? "header" : "parameter"));
    if (!usesHeader) start = stated.front();
  }
  if (!(start >= 2)) {
    bytes.fail(fmt::format("POINT:DATA_START = {:g}, must be a block behind the header", start));
  }
  return static_cast<std::size_t>(start - 1) * c3dBlock;
}

// Samples stand with their frames, so the rate of frames decides.
void checkAnalogRate(const C3dParameters& parameters, const C3dLayout& layout,
                     ReadingNotes& notes) {
  const std::vector<double> stated = parameters.numbers("ANALOG:RATE");
  if (stated.empty() || stated.front() == 0 || layout.channels == 0) return;
  const double rate = layout.rate * static_cast<double>(layout.samplesPerFrame);
  if (std::abs(stated.front() / rate - 1) < 1e-3) return;
  notes.warnings.push_back(fmt::format(
      "ANALOG:RATE = {:g} Hz, but {} samples in each frame at POINT:RATE = {:g} Hz make "
      "{:g} Hz: that was used.",
      stated.front(), layout.samplesPerFrame, layout.rate, rate));
}

}  // namespace

C3dLayout c3dLayoutOf(const Bytes& bytes, const C3dParameters& parameters, ReadingNotes& notes) {
  C3dLayout layout;
  layout.points = agreed(bytes, parameters.numbers("POINT:USED", true), bytes.uint16(2, "header"),
                         "POINT:USED");
  layout.samplesPerFrame = bytes.uint16(18, "header");
  std::size_t perFrame = bytes.uint16(4, "header");
  const std::vector<double> used = parameters.numbers("ANALOG:USED", true);
  // Motion Monitor counts channels here instead of values
  if (layout.samplesPerFrame > 1 && !used.empty() &&
      used.front() == static_cast<double>(perFrame) && perFrame % layout.samplesPerFrame != 0) {
    perFrame *= layout.samplesPerFrame;
  }
  const std::size_t divisor = std::max<std::size_t>(layout.samplesPerFrame, 1);
  if (perFrame % divisor != 0 || (perFrame > 0 && layout.samplesPerFrame == 0)) {
    bytes.fail(fmt::format("header: {} analog values per frame in {} samples, must be a multiple",
                           perFrame, layout.samplesPerFrame));
  }
  layout.channels = agreed(bytes, used, static_cast<double>(perFrame / divisor), "ANALOG:USED");
  layout.scale = static_cast<double>(bytes.float32(12, "header"));
  if (const auto scale = parameters.numbers("POINT:SCALE"); !scale.empty()) {
    if ((scale.front() < 0) != (layout.scale < 0)) {
      bytes.fail(
          fmt::format("POINT:SCALE = {:g}, but the header says {:g}, must have the same sign (it "
                      "tells floats from integers)",
                      scale.front(), layout.scale));
    }
    layout.scale = scale.front();
  }
  if (!std::isfinite(layout.scale) || (layout.points > 0 && layout.scale == 0)) {
    bytes.fail(fmt::format("POINT:SCALE = {:g}, must be finite and not 0", layout.scale));
  }
  layout.data = dataStart(bytes, parameters, notes);
  layout.rate = rateIn(bytes, parameters, notes);
  layout.frames = framesOf(bytes, parameters, layout, notes);
  checkAnalogRate(parameters, layout, notes);
  return layout;
}

}  // namespace bio::tables
