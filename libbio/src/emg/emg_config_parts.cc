#include "emg/emg_config_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "bio/tables/file_error.h"

namespace bio {
namespace {

const auto unit = [](double x) { return x >= 0 && x <= 1; };
const auto above0 = [](double x) { return x > 0 && std::isfinite(x); };

// What stands for the signal: one of electrode, synergy and constant.
void readSource(TomlTable& table, const EmgConfigFile& out, UnrecordedMuscle& muscle) {
  const int given = table.has("electrode") + table.has("synergy") + table.has("constant");
  if (given != 1) table.fail("muscle", "needs one of electrode, synergy and constant");
  if (const auto electrode = table.text("electrode")) muscle.synergy = {{*electrode, 1.0}};
  if (table.has("synergy")) muscle.synergy = table.weights("synergy");
  const char* source = table.has("electrode") ? "electrode" : "synergy";
  if (!table.has("constant") && muscle.synergy.empty()) {
    table.fail(source, "must name at least one electrode");
  }
  for (const auto& [channel, weight] : muscle.synergy) {
    if (!above0(weight)) table.fail(source, fmt::format("weight of '{}' must be > 0", channel));
    const bool isKnown =
        std::any_of(out.emg.electrodes.begin(), out.emg.electrodes.end(),
                    [&, &name = channel](const Electrode& e) { return e.channel == name; });
    if (!isKnown) {
      table.fail(source, fmt::format("no [[electrode]] has the channel '{}'", channel));
    }
  }
  muscle.factor = table
                      .number(
                          "factor", [](double x) { return x > 0 && x <= 1; }, "must be > 0 and ≤ 1")
                      .value_or(1);
  muscle.constant = table.number("constant", unit, "must be 0 to 1").value_or(0);
  if (table.has("constant") && table.has("factor")) {
    table.fail("factor", "has no effect on a constant");
  }
}

std::optional<LatentDeclaration> readLatent(TomlTable& table, const std::string& muscle) {
  const auto sd = table.number("latent_sd", above0, "must be > 0");
  const auto spacing = table.number("knots_s", above0, "must be > 0");
  if (!sd && spacing) table.fail("knots_s", "needs latent_sd");
  if (!sd) return std::nullopt;
  return LatentDeclaration{muscle, *sd, spacing.value_or(LatentDeclaration{}.spacing)};
}

// "x z -y": which axis of the laboratory each of the model's is
void readAxes(TomlTable& table, MarkerDeclaration& markers) {
  const auto text = table.text("axes");
  if (!text) return;
  std::istringstream words(*text);
  std::array<MarkerDeclaration::Axis, 3> axes{};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  std::string word;
  Eigen::Index count = 0;
  const char* rule = "must be three of x, y and z, each with or without a minus, e.g. \"x z -y\"";
  for (; words >> word; ++count) {
    const double sign = word.starts_with('-') ? -1 : 1;
    const std::string axis = sign < 0 ? word.substr(1) : word;
    if (count == 3 || axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z') table.fail("axes", rule);
    axes[static_cast<std::size_t>(count)] = {axis[0] - 'x', sign};
    turn(count, axis[0] - 'x') = sign;
  }
  const double determinant = turn.determinant();
  if (count != 3 || determinant == 0) table.fail("axes", rule);
  if (determinant < 0) {
    table.fail("axes", "must be a turn: this one is a mirror image, change one sign");
  }
  markers.axes = axes;
}

[[noreturn]] void failAt(const EmgConfigFile& config, const std::string& what) {
  throw FileError(fmt::format("{}:{}: [markers] {}", config.file, config.markers->line, what));
}

bool isMeasured(const Recording& recording, const std::string& point) {
  return std::any_of(recording.channels.begin(), recording.channels.end(),
                     [&](const Channel& c) { return c.name == point + ".x"; });
}

// BODY.MARKER that the configuration calls so.
std::string fullName(const EmgConfigFile& config, const std::vector<std::string>& markers,
                     const std::string& name) {
  if (config.markers->model.empty()) return name;
  std::vector<std::string> meant;
  for (const std::string& marker : markers) {
    if (marker == name) return marker;
    if (marker.ends_with("." + name)) meant.push_back(marker);
  }
  if (meant.size() == 1) return meant.front();
  if (!meant.empty()) {
    failAt(config, fmt::format("names: '{}' may be {}", name, fmt::join(meant, " or ")));
  }
  failAt(config, fmt::format("names: the model has no marker '{}'; it has {}", name,
                             fmt::join(markers, ", ")));
}

// Points of the recording and the markers that they are.
std::vector<std::pair<std::string, std::string>> pairsOf(const EmgConfigFile& config,
                                                         const Recording& recording,
                                                         const std::vector<std::string>& markers) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& [point, name] : config.markers->names) {
    if (!isMeasured(recording, point)) {
      failAt(config, fmt::format("names: no recording has a point '{}' that was seen", point));
    }
    pairs.emplace_back(point, fullName(config, markers, name));
  }
  if (!config.markers->names.empty()) return pairs;
  for (const std::string& marker : markers) {
    const std::string own = marker.substr(marker.find('.') + 1);
    for (const std::string& point : {own, marker}) {
      if (!isMeasured(recording, point)) continue;
      pairs.emplace_back(point, marker);
      break;
    }
  }
  if (pairs.empty()) {
    failAt(config, fmt::format("no point is called as a marker of the model ({}): needs names",
                               fmt::join(markers, ", ")));
  }
  return pairs;
}

}  // namespace

void readUnrecorded(TomlTable& root, EmgConfigFile& out) {
  for (TomlTable& table : root.tables("unrecorded")) {
    UnrecordedMuscle one;
    one.muscle = table.required("muscle", table.text("muscle"));
    for (const Electrode& electrode : out.emg.electrodes) {
      for (const auto& [muscle, weight] : electrode.muscles) {
        if (muscle != one.muscle) continue;
        table.fail("muscle", fmt::format("has the electrode '{}'", electrode.channel));
      }
    }
    for (const UnrecordedMuscle& other : out.emg.unrecorded) {
      if (other.muscle == one.muscle) table.fail("muscle", "is given twice");
    }
    if (one.muscle.empty() || one.muscle.find_first_of(" \t;,\"") != std::string::npos) {
      table.fail("muscle", "must be a name without blank, comma, semicolon or quote");
    }
    readSource(table, out, one);
    one.latent = readLatent(table, one.muscle);
    table.finish();
    out.emg.unrecorded.push_back(std::move(one));
  }
}

void readMarkers(TomlTable& root, EmgConfigFile& out) {
  if (!root.has("markers")) return;
  TomlTable table = root.table("markers");
  MarkerDeclaration markers;
  markers.line = table.line();
  markers.model = table.text("model").value_or("");
  if (!markers.model.empty()) {
    markers.model = (std::filesystem::path(out.file).parent_path() / markers.model).string();
  }
  for (auto& [point, name] : table.names("names")) {
    if (markers.model.empty() && name.find('.') == std::string::npos) {
      table.fail("names",
                 fmt::format("'{}' must be BODY.MARKER, or MARKER of a model (model)", name));
    }
    if (name.find_first_of("\t\",") != std::string::npos) {
      table.fail("names", "must be names without tab, comma or quote");
    }
    for (const auto& [otherPoint, other] : markers.names) {
      if (other == name) {
        table.fail("names", fmt::format("'{}' and '{}' are both '{}'", otherPoint, point, name));
      }
    }
    markers.names.emplace(point, name);
  }
  if (markers.model.empty() && markers.names.empty()) {
    table.required<std::string>("names", std::nullopt);
  }
  readAxes(table, markers);
  if (const auto origin = table.numbers("origin_m")) {
    if (origin->size() != 3) table.fail("origin_m", "must be three numbers");
    for (Eigen::Index i = 0; i < 3; ++i) {
      markers.origin[i] = (*origin)[static_cast<std::size_t>(i)];
      if (!std::isfinite(markers.origin[i])) table.fail("origin_m", "must be finite");
    }
  }
  markers.lowPass = table.number("lowpass_Hz", above0, "must be > 0");
  table.finish();
  out.markers = std::move(markers);
}

void addMarkerColumns(const EmgConfigFile& config, const Recording& recording,
                      const std::vector<std::string>& markers, EmgConfig& out) {
  if (!config.markers) return;
  const MarkerDeclaration& declared = *config.markers;
  constexpr std::array<const char*, 3> endings = {".x", ".y", ".z"};
  for (const auto& [point, name] : pairsOf(config, recording, markers)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto from = static_cast<std::size_t>(declared.axes[axis].laboratory);
      MeasuredOptions column;
      column.channel = point + endings[from];
      column.coordinate = name + endings[axis];
      column.sign = declared.axes[axis].sign;
      column.zero = declared.origin[static_cast<Eigen::Index>(from)];
      column.lowPass = declared.lowPass;
      for (const MeasuredOptions& other : out.columns) {
        if (other.coordinate != column.coordinate) continue;
        failAt(config,
               fmt::format("'{}' is given twice, by two names or a [[column]]", other.coordinate));
      }
      out.columns.push_back(std::move(column));
    }
  }
}

}  // namespace bio
