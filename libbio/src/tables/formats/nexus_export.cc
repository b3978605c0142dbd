#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "bio/tables/file_error.h"
#include "bio/tables/units.h"
#include "tables/cells.h"
#include "tables/recording_layouts.h"

// Vicon Nexus's ASCII export: sections, each a name (Devices, Trajectories, Model Outputs, Joints
// …), a rate, a row of devices or points, a row "Frame, Sub Frame, names", a row of units, rows, an
// empty line.
namespace bio {
namespace {

using tables::Separator;
using NexusCells = std::vector<std::string_view>;

constexpr std::array<Separator, 3> nexusSeparators = {Separator::comma, Separator::tab,
                                                      Separator::semicolon};
constexpr double nexusGap = std::numeric_limits<double>::quiet_NaN();

bool isBlank(const std::string& line) {
  return line.find_first_not_of(" \t,;\r\"") == std::string::npos;
}

std::optional<Separator> separatorOfFrames(const std::string& line) {
  for (const Separator separator : nexusSeparators) {
    const NexusCells cells = tables::splitCells(line, separator);
    if (cells.size() > 2 && tables::lowered(cells[0]) == "frame" &&
        tables::lowered(cells[1]).starts_with("sub")) {
      return separator;
    }
  }
  return std::nullopt;
}

struct NexusColumn {
  std::string device, name, unit;
  std::vector<double> values;
};

// A section from the line of its name on.
class NexusSection {
 public:
  NexusSection(const std::string& file, const std::vector<std::string>& lines, std::size_t names,
               ReadingNotes& notes)
      : file_(file),
        lines_(lines),
        names_(names),
        notes_(notes),
        separator_(*separatorOfFrames(lines[names])),
        numbers_(separator_ != Separator::comma) {}

  /// Reads it; returns the line behind it.
  std::size_t read() {
    const std::string title = names_ >= 3 ? textIn(names_ - 3) : "";
    isTrajectories_ = tables::lowered(title).starts_with("traj");
    title_ = title.empty() ? "section" : title;
    const std::string rate = names_ >= 2 ? textIn(names_ - 2) : "";
    double value = 0;
    if (!tables::NumberReader(true).read(rate, value).empty() || !(value > 0) ||
        !std::isfinite(value)) {
      throw FileError(fmt::format("{}:{}: {}: rate = '{}', must be a number > 0 [Hz]", file_,
                                  names_ >= 2 ? names_ - 1 : names_ + 1, title_, rate));
    }
    rate_ = value;
    readColumns();
    std::size_t i = names_ + 2;
    for (; i < lines_.size() && !isBlank(lines_[i]); ++i) readRow(i);
    if (rows_ == 0) throw FileError(fmt::format("{}:{}: {}: holds no rows", file_, i + 1, title_));
    if (!numbers_.undecided().empty()) {
      throw FileError(
          fmt::format("{}: '{}' and all such numbers could have a decimal comma or a comma "
                      "between thousands, must be written with a decimal point",
                      file_, numbers_.undecided()));
    }
    return i;
  }

  void append(std::vector<RawColumn>& out) {
    for (NexusColumn& column : columns_) {
      if (column.name.empty()) continue;
      column.values.resize(places_, nexusGap);
      RawColumn raw;
      raw.number = static_cast<int>(out.size()) + 1;
      raw.unit = column.unit;
      raw.header = column.name;
      raw.rate = rate_;
      raw.startTime = start();
      Channel cut;
      cut.rate = rate_;
      cut.startTime = start();
      cut.values = Eigen::VectorXd::Map(column.values.data(),
                                        static_cast<Eigen::Index>(column.values.size()));
      if (isTrajectories_) toMetres(cut, raw);
      cutEnds(cut);
      raw.startTime = cut.startTime;
      raw.values = std::move(cut.values);
      out.push_back(std::move(raw));
    }
  }

 private:
  std::string textIn(std::size_t line) const {
    return std::string(tables::splitCells(lines_[line], separator_).front());
  }
  double start() const {
    const double perFrame = std::max(1.0, static_cast<double>(subFrames_));
    return ((firstFrame_ - 1) * perFrame + firstSub_) / rate_;
  }

  void readColumns() {
    const NexusCells names = tables::splitCells(lines_[names_], separator_);
    const NexusCells devices =
        names_ >= 1 ? tables::splitCells(lines_[names_ - 1], separator_) : NexusCells{};
    const NexusCells units = names_ + 1 < lines_.size()
                                 ? tables::splitCells(lines_[names_ + 1], separator_)
                                 : NexusCells{};
    std::string device;
    std::map<std::string, int> uses;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (k < devices.size() && !devices[k].empty()) device = devices[k];
      NexusColumn column{.device = device,
                         .name = std::string(names[k]),
                         .unit = k < units.size() ? std::string(units[k]) : "",
                         .values = {}};
      if (k < 2) column.name.clear();
      const bool axis = column.name.size() == 1 && !device.empty() && k >= 2 &&
                        std::string_view("XYZ").find(column.name) != std::string_view::npos;
      // "S1:KNE" and "X" are the channel "S1:KNE.x"
      if (axis) column.name = device + "." + tables::lowered(column.name);
      if (!column.name.empty()) ++uses[column.name];
      columns_.push_back(std::move(column));
    }
    for (NexusColumn& column : columns_) {
      if (uses[column.name] > 1) column.name = column.device + " " + column.name;
    }
  }

  void readRow(std::size_t i) {
    NexusCells cells = tables::splitCells(lines_[i], separator_);
    while (cells.size() > columns_.size() && cells.back().empty()) cells.pop_back();
    if (cells.size() > columns_.size()) {
      throw FileError(fmt::format("{}:{}: has {} cells, must have at most {}, one per name", file_,
                                  i + 1, cells.size(), columns_.size()));
    }
    if (cells.size() < 2) {
      throw FileError(fmt::format("{}:{}: has {} cells, must have frame and sub frame", file_,
                                  i + 1, cells.size()));
    }
    const double frame = number(i, 0, cells[0]), sub = number(i, 1, cells[1]);
    if (rows_ == 0) {
      firstFrame_ = frame;
      firstSub_ = sub;
      countSubFrames(i, frame);
    }
    const double perFrame = std::max(1.0, static_cast<double>(subFrames_));
    const double place = (frame - firstFrame_) * perFrame + sub - firstSub_;
    if (!(place >= static_cast<double>(places_) && place == std::floor(place) &&
          place <= 4 * static_cast<double>(rows_) + 1000)) {
      throw FileError(
          fmt::format("{}:{}: frame {:g}, sub frame {:g} does not follow the row before", file_,
                      i + 1, frame, sub));
    }
    if (place > static_cast<double>(places_) && rows_ > 0 && !missing_) {
      notes_.warnings.push_back(fmt::format(
          "{}: frames are missing before frame {:g} (line {}) and count as not measured.", title_,
          frame, i + 1));
      missing_ = true;
    }
    places_ = static_cast<std::size_t>(place) + 1;
    ++rows_;
    for (std::size_t k = 2; k < cells.size(); ++k) {
      if (cells[k].empty() || tables::lowered(cells[k]) == "nan") continue;
      std::vector<double>& values = columns_[k].values;
      values.resize(places_ - 1, nexusGap);
      values.push_back(number(i, k, cells[k]));
    }
  }

  // Sub frames of the first frame that is whole.
  void countSubFrames(std::size_t i, double first) {
    std::set<double> subs;
    bool behind = false;
    for (std::size_t k = i; k < lines_.size() && !isBlank(lines_[k]); ++k) {
      const NexusCells cells = tables::splitCells(lines_[k], separator_);
      double frame = 0, sub = 0;
      tables::NumberReader reader(false);
      if (cells.size() < 2 || !reader.read(cells[0], frame).empty() ||
          !reader.read(cells[1], sub).empty()) {
        break;
      }
      if (frame > first + 1) break;
      if (frame > first && !behind) {
        behind = true;
        if (firstSub_ == 0) break;
        subs.clear();
      }
      subs.insert(sub);
    }
    subFrames_ = subs.size();
  }

  double number(std::size_t line, std::size_t column, std::string_view cell) {
    double value = 0;
    const std::string_view rule = numbers_.read(cell, value);
    if (rule.empty() && std::isfinite(value)) return value;
    throw FileError(fmt::format("{}:{}: column {} '{}': '{}' {}", file_, line + 1, column + 1,
                                columns_[column].name, cell,
                                rule.empty() ? "must be finite" : rule));
  }

  void toMetres(Channel& channel, RawColumn& raw) const {
    const auto unit = knownUnit(raw.unit);
    if (!unit || unit->si != "m") {
      throw FileError(fmt::format("{}:{}: '{}' is in '{}', must be in mm, cm or m", file_,
                                  names_ + 2, raw.header, raw.unit));
    }
    channel.values *= unit->factor;
    raw.unit = "m";
  }

  const std::string& file_;
  const std::vector<std::string>& lines_;
  std::size_t names_;  ///< line of the names, counted from 0
  ReadingNotes& notes_;
  Separator separator_;
  tables::NumberReader numbers_;
  std::string title_;
  bool isTrajectories_ = false, missing_ = false;
  double rate_ = 0, firstFrame_ = 1, firstSub_ = 0;
  std::size_t subFrames_ = 1, rows_ = 0, places_ = 0;
  std::vector<NexusColumn> columns_;
};

}  // namespace

bool isNexus(const std::vector<std::string>& lines) {
  for (std::size_t i = 2; i < std::min<std::size_t>(lines.size(), 50); ++i) {
    if (separatorOfFrames(lines[i])) return true;
  }
  return false;
}

std::vector<RawColumn> readNexus(const std::string& file, ReadingNotes& notes) {
  const std::vector<std::string> lines = linesOf(file);
  std::vector<RawColumn> out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!separatorOfFrames(lines[i])) continue;
    NexusSection section(file, lines, i, notes);
    i = section.read();
    section.append(out);
  }
  if (out.empty()) {
    throw FileError(
        fmt::format("{}: has no row of names that begins with Frame and Sub Frame", file));
  }
  return out;
}

}  // namespace bio
