#include "bio/tables/c3d_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "bio/tables/file_error.h"
#include "tables/c3d_parameters.h"
#include "tables/length_unit.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using tables::Bytes;
using tables::C3dParameters;
using tables::NumberFormat;

constexpr std::size_t block = 512;
constexpr double notSeen = std::numeric_limits<double>::quiet_NaN();

// Byte of the parameter section's start and its format of numbers, from what all formats share.
struct Start {
  std::size_t parameters = 0;
  NumberFormat format = NumberFormat::little;
};
std::optional<Start> startOf(std::string_view bytes) {
  if (bytes.size() < 2 || bytes[1] != 0x50 || bytes[0] == 0) return std::nullopt;
  Start start;
  start.parameters = (static_cast<std::uint8_t>(bytes[0]) - 1U) * block;
  if (start.parameters + 4 > bytes.size()) return std::nullopt;
  switch (static_cast<std::uint8_t>(bytes[start.parameters + 3])) {
    case 84:
      start.format = NumberFormat::little;
      return start;
    case 85:
      start.format = NumberFormat::dec;
      return start;
    case 86:
      start.format = NumberFormat::big;
      return start;
    default:
      return std::nullopt;
  }
}

// What decides how the data section is read.
struct Layout {
  std::size_t points = 0;
  std::size_t channels = 0;
  std::size_t samplesPerFrame = 0;
  std::size_t frames = 0;
  double firstFrame = 1;  // counted from 1
  double rate = 0;        // of frames [Hz]
  double scale = 1;       // of points; < 0: floats
  std::size_t data = 0;   // [byte]

  bool floats() const { return scale < 0; }
  std::size_t width() const { return floats() ? 4 : 2; }
  std::size_t valuesPerFrame() const { return 4 * points + channels * samplesPerFrame; }
};

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

// The first of what counts frames: it is exact beyond 65535, where the header is not.
std::size_t framesOf(const Bytes& bytes, const C3dParameters& parameters, Layout& layout,
                     std::vector<std::string>& remarks) {
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
    remarks.push_back(fmt::format("{}, but the header says {:g} to {:g}: the header was not used.",
                                  source, first, last));
  }
  return static_cast<std::size_t>(frames);
}

double rateIn(const Bytes& bytes, const C3dParameters& parameters,
              std::vector<std::string>& remarks) {
  const double header = static_cast<double>(bytes.float32(20, "header"));
  const std::vector<double> parameter = parameters.numbers("POINT:RATE");
  const double rate = parameter.empty() ? header : parameter.front();
  if (!(rate > 0 && rate < 1e9)) {
    bytes.fail(fmt::format("POINT:RATE = {:g} Hz, must be > 0", rate));
  }
  if (!(std::abs(header / rate - 1) < 1e-3)) {
    remarks.push_back(
        fmt::format("POINT:RATE = {:g} Hz, but the header says {:g} Hz: the header was not used.",
                    rate, header));
  }
  return rate;
}

Layout layoutOf(const Bytes& bytes, const C3dParameters& parameters,
                std::vector<std::string>& remarks) {
  Layout layout;
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
  std::vector<double> start = parameters.numbers("POINT:DATA_START", true);
  std::erase(start, 0.0);  // 0: not stated
  layout.data = agreed(bytes, start, bytes.uint16(16, "header"), "POINT:DATA_START");
  if (layout.data < 2) {
    bytes.fail(
        fmt::format("POINT:DATA_START = {}, must be a block behind the header", layout.data));
  }
  layout.data = (layout.data - 1) * block;
  layout.rate = rateIn(bytes, parameters, remarks);
  layout.frames = framesOf(bytes, parameters, layout, remarks);
  const std::size_t frame = layout.valuesPerFrame() * layout.width();
  if (frame == 0) bytes.fail("has neither points nor analog channels, must have some");
  const std::size_t held = layout.data < bytes.size() ? (bytes.size() - layout.data) / frame : 0;
  if (layout.frames > held) {
    bytes.fail(fmt::format("promises {} frames, its data section holds {} (cut off?)",
                           layout.frames, held));
  }
  return layout;
}

double valueIn(const Bytes& bytes, const Layout& layout, std::size_t at, bool isUnsigned) {
  if (layout.floats()) return static_cast<double>(bytes.float32Within(at));
  const std::uint16_t bits = bytes.uint16Within(at);
  return isUnsigned ? bits : static_cast<std::int16_t>(bits);
}

// Labels of points that are angles, forces …, as modelling software adds them.
std::set<std::string> noPositions(const C3dParameters& parameters) {
  std::set<std::string> out;
  for (const char* kind : {"ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"}) {
    for (std::string& label : parameters.texts(std::string("POINT:") + kind)) {
      if (!label.empty()) out.insert(std::move(label));
    }
  }
  return out;
}

// "HEAD", "HEAD (2)", …
class UniqueNames {
 public:
  std::string operator()(const std::string& label) {
    std::string name = label;
    for (int& k = uses_[label]; !used_.insert(name).second;) {
      name = fmt::format("{} ({})", label, ++k + 1);
    }
    return name;
  }

 private:
  std::map<std::string, int> uses_;
  std::set<std::string> used_;
};

MarkerTrajectories markersOf(const Bytes& bytes, const C3dParameters& parameters,
                             const Layout& layout) {
  MarkerTrajectories out;
  out.file = bytes.file();
  out.rate = layout.rate;
  const std::vector<std::string> labels = parameters.texts("POINT:LABELS");
  const std::set<std::string> others = noPositions(parameters);
  std::vector<std::size_t> kept;
  std::vector<std::string> leftOut;
  UniqueNames unique;
  for (std::size_t k = 0; k < layout.points; ++k) {
    const std::string label = k < labels.size() ? labels[k] : "";
    if (others.count(label) > 0) {
      leftOut.push_back(label);
      continue;
    }
    kept.push_back(k);
    out.names.push_back(unique(label.empty() ? fmt::format("point {}", k + 1) : label));
  }
  if (!leftOut.empty()) {
    out.remarks.push_back(
        fmt::format("{} points are angles, forces, moments, powers or scalars and "
                    "were left out.",
                    leftOut.size()));
  }
  if (kept.empty()) return out;
  const auto frames = static_cast<Eigen::Index>(layout.frames);
  out.times = Eigen::VectorXd::NullaryExpr(frames, [&](Eigen::Index f) {
    return (layout.firstFrame - 1 + static_cast<double>(f)) / layout.rate;
  });
  const std::vector<std::string> units = parameters.texts("POINT:UNITS");
  const std::string unit = units.empty() || units.front().empty() ? "mm" : units.front();
  if (units.empty() || units.front().empty()) {
    out.remarks.emplace_back("POINT:UNITS is absent: positions are taken for millimetres.");
  }
  const double metres = tables::metresPer(unit);
  if (!(metres > 0)) bytes.fail(fmt::format("POINT:UNITS = '{}', must be mm, cm or m", unit));
  const double scale = (layout.floats() ? 1.0 : layout.scale) * metres;
  out.positions.resize(frames, static_cast<Eigen::Index>(3 * kept.size()));
  const std::size_t frameBytes = layout.valuesPerFrame() * layout.width();
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t f = 0; f < layout.frames; ++f) {
      const std::size_t at = layout.data + f * frameBytes + kept[i] * 4 * layout.width();
      // the fourth number: residual and cameras, below 0 for a point that was not seen
      const bool seen = valueIn(bytes, layout, at + 3 * layout.width(), false) >= 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = scale * valueIn(bytes, layout, at + axis * layout.width(), false);
        out.positions(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(3 * i + axis)) =
            seen && std::isfinite(value) ? value : notSeen;
      }
    }
  }
  return out;
}

std::vector<Channel> analogOf(const Bytes& bytes, const C3dParameters& parameters,
                              const Layout& layout) {
  const std::vector<std::string> formats = parameters.texts("ANALOG:FORMAT");
  const bool isUnsigned = !formats.empty() && formats.front() == "UNSIGNED";
  const std::vector<std::string> labels = parameters.texts("ANALOG:LABELS");
  const std::vector<std::string> units = parameters.texts("ANALOG:UNITS");
  const std::vector<double> scales = parameters.allNumbers("ANALOG:SCALE");
  const std::vector<double> offsets = parameters.allNumbers("ANALOG:OFFSET", isUnsigned);
  const std::vector<double> general = parameters.numbers("ANALOG:GEN_SCALE");
  const std::size_t frameBytes = layout.valuesPerFrame() * layout.width();
  const auto samples = layout.frames * layout.samplesPerFrame;
  std::vector<Channel> out;
  for (std::size_t k = 0; k < layout.channels; ++k) {
    Channel channel;
    channel.name =
        k < labels.size() && !labels[k].empty() ? labels[k] : fmt::format("analog {}", k + 1);
    channel.unit = k < units.size() ? units[k] : "";
    channel.rate = layout.rate * static_cast<double>(layout.samplesPerFrame);
    channel.startTime = (layout.firstFrame - 1) / layout.rate;
    const double scale =
        (k < scales.size() ? scales[k] : 1.0) * (general.empty() ? 1.0 : general.front());
    const double offset = k < offsets.size() ? offsets[k] : 0.0;
    if (!std::isfinite(scale) || !std::isfinite(offset)) {
      bytes.fail(
          fmt::format("analog channel '{}': SCALE·GEN_SCALE = {:g}, OFFSET = {:g}, must be "
                      "finite",
                      channel.name, scale, offset));
    }
    channel.values.resize(static_cast<Eigen::Index>(samples));
    Eigen::Index i = 0;
    for (std::size_t f = 0; f < layout.frames; ++f) {
      std::size_t at = layout.data + f * frameBytes + (4 * layout.points + k) * layout.width();
      for (std::size_t s = 0; s < layout.samplesPerFrame; ++s) {
        const double value = (valueIn(bytes, layout, at, isUnsigned) - offset) * scale;
        channel.values[i++] = std::isfinite(value) ? value : notSeen;
        at += layout.channels * layout.width();
      }
    }
    cutEnds(channel);
    out.push_back(std::move(channel));
  }
  return out;
}

}  // namespace

C3dFile readC3d(const std::filesystem::path& file) {
  return c3dFrom(readTextFile(file), file.string());
}

C3dFile c3dFrom(std::string_view content, const std::string& name) {
  const std::optional<Start> start = startOf(content);
  if (!start) {
    throw FileError(
        fmt::format("{}: is no C3D file, must begin with its header and parameters", name));
  }
  const Bytes bytes(name, content, start->format);
  bytes.require(0, block, "header");
  const C3dParameters parameters(bytes, start->parameters);
  C3dFile out;
  const Layout layout = layoutOf(bytes, parameters, out.remarks);
  out.markers = markersOf(bytes, parameters, layout);
  out.analog = analogOf(bytes, parameters, layout);
  return out;
}

bool tables::isC3d(std::string_view bytes) {
  return startOf(bytes).has_value();
}

}  // namespace bio
