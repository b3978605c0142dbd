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
#include "tables/formats/c3d_layout.h"
#include "tables/formats/c3d_parameters.h"
#include "tables/length_unit.h"
#include "tables/recording_layouts.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using tables::Bytes;
using tables::C3dParameters;
using tables::NumberFormat;

constexpr std::size_t block = tables::c3dBlock;
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

using Layout = tables::C3dLayout;

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
                             const Layout& layout, ReadingNotes& notes) {
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
  if (!(metres > 0)) {
    notes.warnings.push_back(
        fmt::format("POINT:UNITS = '{}', must be mm, cm or m: the {} points were not read.", unit,
                    kept.size()));
    out.names.clear();
    out.times.resize(0);
    return out;
  }
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
                              const Layout& layout, ReadingNotes& notes) {
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
      notes.warnings.push_back(
          fmt::format("Analog channel '{}': SCALE·GEN_SCALE = {:g}, OFFSET = {:g}, must be finite: "
                      "it was not read.",
                      channel.name, scale, offset));
      continue;
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
  ReadingNotes notes;
  const Layout layout = tables::c3dLayoutOf(bytes, parameters, notes);
  out.markers = markersOf(bytes, parameters, layout, notes);
  out.analog = analogOf(bytes, parameters, layout, notes);
  out.remarks = std::move(notes.remarks);
  out.warnings = std::move(notes.warnings);
  return out;
}

bool tables::isC3d(std::string_view bytes) {
  return startOf(bytes).has_value();
}

}  // namespace bio
