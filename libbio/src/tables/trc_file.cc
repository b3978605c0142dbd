#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "bio/tables/c3d_file.h"
#include "bio/tables/file_error.h"
#include "bio/tables/marker_trajectories.h"
#include "tables/c3d_parameters.h"
#include "tables/cells.h"
#include "tables/length_unit.h"
#include "tables/text_file.h"

namespace bio {

double tables::metresPer(std::string_view unit) {
  const std::string low = lowered(trimmed(unit));
  // some programs keep the first letters only
  const auto begins = [&](std::string_view whole) {
    return low.size() > 2 && whole.starts_with(low);
  };
  if (low == "mm" || begins("millimeters") || begins("millimetres")) return 1e-3;
  if (low == "cm" || begins("centimeters") || begins("centimetres")) return 1e-2;
  if (low == "m" || begins("meters") || begins("metres")) return 1;
  return 0;
}

namespace {

using Cells = std::vector<std::string_view>;
constexpr double notSeenMarker = std::numeric_limits<double>::quiet_NaN();

class TrcReader {
 public:
  TrcReader(std::string file, std::string_view text) : lines_(text), mostCells_(4 * text.size()) {
    out_.file = std::move(file);
  }

  MarkerTrajectories read() {
    const std::string_view first = next().front();
    if (first != "PathFileType") {
      fail(first.starts_with("PathFileType")
               ? "'PathFileType' is not followed by a tab, cells must be between tabs"
               : "is no TRC file, must begin with PathFileType");
    }
    readHeader();
    readNames();
    readRows();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", out_.file, lines_.number(), onOneLine(what)));
  }
  // The cells of the next line, at least one.
  Cells next() {
    std::string_view line;
    if (!lines_.next(line)) fail("ends here, must have five header lines and then frames");
    return tables::splitCells(line, tables::Separator::tab);
  }
  double number(std::string_view cell, const std::string& name) {
    double value = 0;
    const std::string_view rule = numbers_.read(cell, value);
    if (!rule.empty()) fail(fmt::format("{} = '{}', {}", name, cell, rule));
    if (!std::isfinite(value)) fail(fmt::format("{} = {}, must be finite", name, cell));
    return value;
  }
  std::size_t count(const std::map<std::string, std::string_view>& header, const std::string& key) {
    const auto found = header.find(key);
    if (found == header.end()) fail(fmt::format("has no {}, must have one", key));
    const double value = number(found->second, key);
    if (!(value >= 1 && value <= 1e9 && value == std::floor(value))) {
      fail(fmt::format("{} = {:g}, must be a whole number ≥ 1", key, value));
    }
    return static_cast<std::size_t>(value);
  }

  void readHeader() {
    const Cells keys = next(), values = next();
    std::map<std::string, std::string_view> header;
    for (std::size_t k = 0; k < std::min(keys.size(), values.size()); ++k) {
      header.emplace(keys[k], values[k]);
    }
    if (header.count("DataRate") == 0) fail("has no DataRate, must have one");
    out_.rate = number(header["DataRate"], "DataRate");
    if (!(out_.rate > 0)) fail(fmt::format("DataRate = {:g} Hz, must be > 0", out_.rate));
    frames_ = count(header, "NumFrames");
    markers_ = count(header, "NumMarkers");
    if (header.count("Units") == 0) fail("has no Units, must have mm, cm or m");
    metres_ = tables::metresPer(header["Units"]);
    if (!(metres_ > 0)) fail(fmt::format("Units = '{}', must be mm, cm or m", header["Units"]));
  }

  // "Frame#", "Time", then a name above the first of three columns each.
  void readNames() {
    const Cells cells = next();
    if (cells.size() < 2 || tables::lowered(cells[0]) != "frame#" ||
        tables::lowered(cells[1]) != "time") {
      fail(fmt::format("begins with '{}', must begin with Frame# and Time", cells[0]));
    }
    std::set<std::string_view> seen;
    for (std::size_t k = 2; k < cells.size(); ++k) {
      if (cells[k].empty()) continue;
      if ((k - 2) % 3 != 0) {
        fail(fmt::format("marker '{}' in column {}, must be above the first of its three columns",
                         cells[k], k + 1));
      }
      if (out_.names.size() != (k - 2) / 3) {
        fail(fmt::format("no marker in column {}, must have a name", 3 * out_.names.size() + 3));
      }
      if (!seen.insert(cells[k]).second) {
        fail(fmt::format("second marker called '{}', names must be unique", cells[k]));
      }
      out_.names.emplace_back(onOneLine(std::string(cells[k])));
    }
    if (out_.names.size() != markers_) {
      fail(fmt::format("{} names of markers, the header promises {}", out_.names.size(), markers_));
    }
    next();  // X1, Y1, Z1, …
  }

  void readRows() {
    const std::size_t width = 2 + 3 * markers_;
    std::vector<double> times, cells;
    for (std::string_view line; lines_.next(line);) {
      if (tables::trimmed(line).empty()) continue;
      Cells row = tables::splitCells(line, tables::Separator::tab);
      while (row.size() > width && row.back().empty()) row.pop_back();
      if (row.size() > width || row.size() < 2) {
        fail(fmt::format("row has {} cells, must have {} for {} markers", row.size(), width,
                         markers_));
      }
      number(row[0], "Frame#");
      times.push_back(number(row[1], "Time"));
      for (std::size_t m = 0; m < markers_; ++m) readMarker(row, m, cells);
      checkTime(times);
      if (cells.size() > mostCells_) fail("most cells are missing, must have their separators");
    }
    if (times.size() != frames_) {
      fail(fmt::format("{} frames, the header promises {}", times.size(), frames_));
    }
    const auto rows = static_cast<Eigen::Index>(times.size());
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    out_.times = Eigen::VectorXd::Map(times.data(), rows);
    out_.positions = metres_ * Eigen::Map<const RowMajor>(cells.data(), rows,
                                                          static_cast<Eigen::Index>(3 * markers_));
  }

  void readMarker(const Cells& row, std::size_t marker, std::vector<double>& cells) {
    int seen = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t k = 2 + 3 * marker + axis;
      const std::string_view cell = k < row.size() ? row[k] : std::string_view{};
      const bool empty = cell.empty() || tables::lowered(cell) == "nan";
      seen += empty ? 0 : 1;
      cells.push_back(empty ? notSeenMarker
                            : number(cell, fmt::format("marker '{}'", out_.names[marker])));
    }
    if (seen != 0 && seen != 3) {
      fail(fmt::format("marker '{}' has {} of 3 coordinates, must have all or none",
                       out_.names[marker], seen));
    }
  }

  void checkTime(const std::vector<double>& times) const {
    const auto k = static_cast<double>(times.size() - 1);
    const double off = (times.back() - times.front()) * out_.rate - k;
    if (!(std::abs(off) <= 0.25)) {
      fail(fmt::format(
          "Time = {:g} s is {:.2g} intervals away from equal spacing at DataRate = {:g} "
          "Hz, must be at most 0.25",
          times.back(), std::abs(off), out_.rate));
    }
  }

  tables::Lines lines_;
  std::size_t mostCells_;  ///< what a file of this size can ask for
  tables::NumberReader numbers_{true};
  MarkerTrajectories out_;
  std::size_t frames_ = 0, markers_ = 0;
  double metres_ = 1;
};

}  // namespace

MarkerTrajectories readTrc(const std::filesystem::path& file) {
  return trcFrom(readTextFile(file), file.string());
}

MarkerTrajectories trcFrom(std::string_view text, const std::string& name) {
  tables::requireTableText(text, name);
  return TrcReader(name, text).read();
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
