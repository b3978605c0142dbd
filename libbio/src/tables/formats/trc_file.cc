#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "bio/tables/c3d_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/marker_trajectories.h"
#include "tables/cells.h"
#include "tables/formats/c3d_parameters.h"
#include "tables/length_unit.h"
#include "tables/text_file.h"

namespace bio {

namespace {

using Cells = std::vector<std::string_view>;
constexpr double notSeenMarker = std::numeric_limits<double>::quiet_NaN();

/// Frames as the file has them; a marker's three columns follow each other.
struct TrcRows {
  std::vector<double> times;  ///< NaN: no number
  std::vector<Cells> cells;   ///< behind the frame's number and time, without empty ones at the end
  std::vector<int> lines;     ///< of the file
};

/// Reads by order: two columns for frame and time, then three for each marker. What names, labels
/// and counts say beside that is compared, and told where it contradicts.
class TrcReader {
 public:
  TrcReader(std::string file, std::string_view text) : lines_(text), mostCells_(4 * text.size()) {
    out_.file = std::move(file);
  }

  MarkerTrajectories read() {
    std::string_view line = next();
    if (!tables::trimmed(line).starts_with("PathFileType")) {
      fail("is no TRC file, must begin with PathFileType");
    }
    readHeader();
    readNames(next());
    readRows();
    settleNames();
    settleTimes();
    takePositions();
    return std::move(out_);
  }

 private:
  [[noreturn]] void failAt(int line, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", out_.file, line, onOneLine(what)));
  }
  [[noreturn]] void fail(const std::string& what) const { failAt(lines_.number(), what); }
  void remark(const std::string& what) { out_.remarks.push_back(onOneLine(what)); }

  // The next line that is not empty.
  std::string_view next() {
    std::string_view line;
    while (lines_.next(line)) {
      if (tables::trimmed(line).find_first_not_of(",;\t ") != line.npos) return line;
    }
    fail("ends here, must have five header lines and then frames");
  }
  // Between tabs if there are any, else between commas, else between blanks.
  Cells cellsOf(std::string_view line) const {
    const bool tabs = line.find('\t') != line.npos;
    const bool commas = line.find(',') != line.npos;
    return tables::splitCells(line, tabs     ? tables::Separator::tab
                                    : commas ? tables::Separator::comma
                                             : tables::Separator::space);
  }
  double number(std::string_view cell, const std::string& name, int line) {
    double value = 0;
    const std::string_view rule = numbers_.read(cell, value);
    if (!rule.empty()) failAt(line, fmt::format("{} = '{}', {}", name, cell, rule));
    if (!std::isfinite(value)) failAt(line, fmt::format("{} = {}, must be finite", name, cell));
    return value;
  }
  // A count that the header states; nothing where it is no whole number.
  std::optional<std::size_t> count(const std::map<std::string, std::string_view>& header,
                                   const char* key) {
    const auto found = header.find(tables::lowered(key));
    double value = 0;
    if (found == header.end() || found->second.empty()) return {};
    if (!numbers_.read(found->second, value).empty() || !(value >= 0 && value <= 1e9)) {
      remark(fmt::format("{} = '{}' is no count and was not used", key, found->second));
      return {};
    }
    return static_cast<std::size_t>(value);
  }

  void readHeader() {
    const Cells keys = cellsOf(next());
    const int line = lines_.number() + 1;
    const Cells values = cellsOf(next());
    std::map<std::string, std::string_view> header;
    for (std::size_t k = 0; k < std::min(keys.size(), values.size()); ++k) {
      header.emplace(tables::lowered(keys[k]), values[k]);
    }
    for (const char* key : {"datarate", "camerarate"}) {
      if (out_.rate > 0 || header.count(key) == 0 || header[key].empty()) continue;
      const char* name = key[0] == 'd' ? "DataRate" : "CameraRate";
      out_.rate = number(header[key], name, line);
      if (!(out_.rate > 0)) failAt(line, fmt::format("{} = {:g} Hz, must be > 0", name, out_.rate));
    }
    frames_ = count(header, "NumFrames");
    markers_ = count(header, "NumMarkers");
    if (header.count("units") == 0) failAt(line, "has no Units, must have mm, cm or m");
    metres_ = tables::metresPer(header["units"]);
    if (!(metres_ > 0))
      failAt(line, fmt::format("Units = '{}', must be mm, cm or m", header["units"]));
  }

  // "Frame#", "Time", then names in order; they stand above the first of three columns each, if at
  // all.
  void readNames(std::string_view line) {
    if (line.find('\t') == line.npos && line.find(',') != line.npos) commas();
    const Cells cells = cellsOf(line);
    const auto begins = [&](std::size_t k, const char* word) {
      return k < cells.size() && (cells[k].empty() || tables::lowered(cells[k]).starts_with(word));
    };
    if (!begins(0, "frame") || !begins(1, "time")) {
      fail(fmt::format("begins with '{}' and '{}', must begin with Frame# and Time",
                       cells.empty() ? "" : cells[0], cells.size() < 2 ? "" : cells[1]));
    }
    for (std::size_t k = 2; k < cells.size(); ++k) {
      if (cells[k].empty()) continue;
      inThrees_ = inThrees_ && (k - 2) % 3 == 0;
      named_.emplace_back((k - 2) / 3, onOneLine(std::string(cells[k])));
    }
    namesLine_ = lines_.number();
  }
  void commas() { numbers_ = tables::NumberReader(false); }

  static bool isLabel(std::string_view cell) {
    return !cell.empty() && (cell[0] == 'X' || cell[0] == 'x' || cell[0] == 'Y' || cell[0] == 'y' ||
                             cell[0] == 'Z' || cell[0] == 'z');
  }
  static bool isMissing(std::string_view cell) {
    const std::string low = tables::lowered(cell);
    return low.empty() || low == "nan" || low == "na" || low == "n/a" || low == "null" ||
           low == "none";
  }

  void readRows() {
    for (std::string_view line; lines_.next(line);) {
      Cells row = cellsOf(line);
      while (!row.empty() && row.back().empty()) row.pop_back();
      if (row.empty()) continue;
      const bool isFirst = rows_.cells.empty() && !labels_;
      if (isFirst && std::all_of(row.begin(), row.end(), [](std::string_view cell) {
            return cell.empty() || isLabel(cell);
          })) {
        labels_ = std::count_if(row.begin(), row.end(), isLabel);
        continue;
      }
      if (row.size() < 2) {
        fail(fmt::format("row has {} cells, must have a frame, a time and three for each marker",
                         row.size()));
      }
      if (!isMissing(row[0])) number(row[0], "Frame#", lines_.number());
      rows_.times.push_back(isMissing(row[1]) ? notSeenMarker
                                              : number(row[1], "Time", lines_.number()));
      rows_.cells.emplace_back(row.begin() + 2, row.end());
      rows_.lines.push_back(lines_.number());
      most_ = std::max(most_, row.size() - 2);
      if (rows_.cells.size() * std::max<std::size_t>(most_, named_.size()) > mostCells_) {
        fail("most cells are missing, must have their separators");
      }
    }
    if (rows_.cells.empty()) fail("holds no frame");
    if (frames_ && *frames_ != rows_.cells.size()) {
      remark(fmt::format("{} frames, NumFrames promises {}: all that are there were read",
                         rows_.cells.size(), *frames_));
    }
  }

  // How many markers there are is what the rows hold.
  void settleNames() {
    std::size_t markers = (most_ + 2) / 3;
    const auto labelled = static_cast<std::size_t>((labels_.value_or(0) + 2) / 3);
    // markers at the end that are never seen have a name or labels
    markers = std::max(markers, std::min(std::max(labelled, named_.size()),
                                         std::max(markers_.value_or(0), named_.size())));
    if (named_.size() > markers || most_ > 3 * markers) {
      failAt(namesLine_,
             fmt::format("{} names of markers, but rows hold {} columns of coordinates, "
                         "must have three for each",
                         named_.size(), most_));
    }
    std::vector<std::string> names(markers);
    const bool byPlace = inThrees_ && !named_.empty() && named_.back().first < markers;
    for (std::size_t k = 0; k < named_.size(); ++k) {
      names[byPlace ? named_[k].first : k] = named_[k].second;
    }
    if (!byPlace && named_.size() < markers) {
      failAt(namesLine_, fmt::format("{} names of markers for {} columns of coordinates, must have "
                                     "one above every third",
                                     named_.size(), most_));
    }
    if (markers_ && *markers_ != markers) {
      remark(fmt::format("{} markers, NumMarkers promises {}: all that are there were read",
                         markers, *markers_));
    }
    std::set<std::string> used;
    for (std::size_t m = 0; m < markers; ++m) {
      if (names[m].empty()) {
        names[m] = fmt::format("marker{}", m + 1);
        remark(fmt::format("the marker in column {} has no name and is called '{}'", 3 * m + 3,
                           names[m]));
      }
      std::string name = names[m];
      for (int again = 2; !used.insert(name).second; ++again) {
        name = fmt::format("{} ({})", names[m], again);
      }
      if (name != names[m]) {
        remark(fmt::format("a further marker called '{}' is called '{}'", names[m], name));
      }
      out_.names.push_back(name);
    }
  }

  // DataRate where the times agree or say nothing, else the rate of the times.
  void settleTimes() {
    const std::vector<double>& times = rows_.times;
    const auto n = static_cast<double>(times.size() - 1);
    const bool all =
        std::all_of(times.begin(), times.end(), [](double t) { return !std::isnan(t); });
    const bool rise = all && times.back() > times.front();
    if (!rise) {
      if (!(out_.rate > 0)) fail("has neither times that rise nor a DataRate");
      if (times.size() > 1) remark("the times say nothing; they were taken from DataRate");
      rows_.times.resize(times.size());
      const double first = std::isnan(times.front()) ? 0 : times.front();
      for (std::size_t k = 0; k < times.size(); ++k) {
        rows_.times[k] = first + static_cast<double>(k) / out_.rate;
      }
      return;
    }
    const double own = n / (times.back() - times.front());
    if (!(out_.rate > 0)) {
      out_.rate = own;
      remark(fmt::format("has no DataRate; that of the times, {:g} Hz, was taken", own));
    } else if (std::abs(n - (times.back() - times.front()) * out_.rate) > 0.25 && isSteady(own)) {
      remark(fmt::format("DataRate = {:g} Hz, but the times rise at {:g} Hz: that was taken",
                         out_.rate, own));
      out_.rate = own;
    }
  }
  bool isSteady(double rate) const {
    for (std::size_t k = 0; k < rows_.times.size(); ++k) {
      const double off = (rows_.times[k] - rows_.times[0]) * rate - static_cast<double>(k);
      if (std::abs(off) > 0.25) return false;
    }
    return true;
  }

  // The place of a frame behind the first; frames that were dropped leave theirs empty.
  std::size_t placeOf(std::size_t k, std::size_t before) const {
    const double place = (rows_.times[k] - rows_.times[0]) * out_.rate;
    const double whole = std::round(place);
    if (!(std::abs(place - whole) <= 0.25) || (k > 0 && whole <= static_cast<double>(before)) ||
        whole > static_cast<double>(mostCells_)) {
      failAt(rows_.lines[k],
             fmt::format("Time = {:g} s is {:.2g} intervals away from equal spacing at DataRate = "
                         "{:g} Hz, must be at most 0.25",
                         rows_.times[k], std::abs(place - static_cast<double>(k)), out_.rate));
    }
    return static_cast<std::size_t>(whole);
  }

  void takePositions() {
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < rows_.times.size(); ++k) {
      places.push_back(placeOf(k, places.empty() ? 0 : places.back()));
    }
    const auto frames = static_cast<Eigen::Index>(places.back() + 1);
    const auto columns = static_cast<Eigen::Index>(3 * out_.names.size());
    if (static_cast<double>(frames) * static_cast<double>(columns) >
        static_cast<double>(mostCells_)) {
      fail("most frames are missing, must be there");
    }
    out_.times = Eigen::VectorXd::NullaryExpr(frames, [&](Eigen::Index k) {
      return rows_.times[0] + static_cast<double>(k) / out_.rate;
    });
    out_.positions = Eigen::MatrixXd::Constant(frames, columns, notSeenMarker);
    std::size_t cut = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      out_.times[static_cast<Eigen::Index>(places[k])] = rows_.times[k];
      for (std::size_t m = 0; m < out_.names.size(); ++m) cut += readMarker(k, m, places[k]);
    }
    if (places.size() < places.back() + 1) {
      remark(fmt::format("{} frames are missing between others and count as not seen",
                         places.back() + 1 - places.size()));
    }
    if (cut > 0) {
      remark(fmt::format("{} positions lack one or two of three coordinates and count as not seen",
                         cut));
    }
  }

  // 1 where only one or two coordinates are there.
  std::size_t readMarker(std::size_t frame, std::size_t marker, std::size_t place) {
    const Cells& row = rows_.cells[frame];
    Eigen::Vector3d position = Eigen::Vector3d::Constant(notSeenMarker);
    int seen = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t k = 3 * marker + axis;
      if (k >= row.size() || isMissing(row[k])) continue;
      position[static_cast<Eigen::Index>(axis)] =
          metres_ * number(row[k], fmt::format("marker '{}', column {}", out_.names[marker], k + 3),
                           rows_.lines[frame]);
      ++seen;
    }
    if (seen == 3) {
      out_.positions.block<1, 3>(static_cast<Eigen::Index>(place),
                                 static_cast<Eigen::Index>(3 * marker)) = position.transpose();
    }
    return seen == 1 || seen == 2 ? 1 : 0;
  }

  tables::Lines lines_;
  std::size_t mostCells_;  ///< what a file of this size can ask for
  tables::NumberReader numbers_{true};
  MarkerTrajectories out_;
  std::optional<std::size_t> frames_, markers_;  ///< as the header says
  double metres_ = 1;
  std::vector<std::pair<std::size_t, std::string>> named_;  ///< place by column, name
  bool inThrees_ = true;  ///< every name stands above the first of three columns
  int namesLine_ = 0;
  std::optional<std::ptrdiff_t> labels_;  ///< X1, Y1, Z1, …
  std::size_t most_ = 0;                  ///< cells of coordinates in the longest row
  TrcRows rows_;
};

}  // namespace

MarkerTrajectories readTrc(const std::filesystem::path& file) {
  return trcFrom(readTextFile(file), file.string());
}

MarkerTrajectories trcFrom(std::string_view text, const std::string& name) {
  tables::requireTableText(text, name);
  const std::string readable = tables::inUtf8(std::string(text));
  return TrcReader(name, readable).read();
}

MarkerTrajectories readMarkers(const std::filesystem::path& file) {
  const std::string content = readTextFile(file);
  return tables::isC3d(content) ? c3dFrom(content, file.string()).markers
                                : trcFrom(content, file.string());
}

Eigen::MatrixX3d positionsOf(const MarkerTrajectories& markers, const std::string& name) {
  const auto found = std::find(markers.names.begin(), markers.names.end(), name);
  if (found == markers.names.end()) {
    throw std::invalid_argument(fmt::format("{}: no marker '{}'; the file has {}", markers.file,
                                            name, fmt::join(markers.names, ", ")));
  }
  return markers.positions.middleCols<3>(3 * (found - markers.names.begin()));
}

}  // namespace bio
