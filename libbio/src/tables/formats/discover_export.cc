#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "bio/tables/file_error.h"
#include "tables/cells.h"
#include "tables/recording_layouts.h"

// Delsys Trigno Discover's CSV: lines about the recording; names of sensors, their modes; a row of
// names, each signal behind its own times; rates [Hz]; intervals [s]; rows of any length; at the
// right a table of events. With a decimal comma cells are parted by a comma and a blank.
namespace bio {
namespace {

using DiscoverCells = std::vector<std::string>;
constexpr std::array<std::string_view, 4> discoverMarks = {"\t", ";", ", ", ","};
constexpr std::size_t lastRatesLine = 40;

DiscoverCells cellsBetween(std::string_view line, std::string_view mark) {
  DiscoverCells cells;
  while (true) {
    const auto end = line.find(mark);
    std::string_view cell = tables::trimmed(line.substr(0, end));
    // the comma of an empty last cell can lack its blank
    if (end == line.npos && mark == ", " && cell.ends_with(',')) cell.remove_suffix(1);
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') {
      cell = tables::trimmed(cell.substr(1, cell.size() - 2));
    }
    cells.emplace_back(cell);
    if (end == line.npos) return cells;
    line.remove_prefix(end + mark.size());
  }
}

std::string cellAt(const DiscoverCells& cells, std::size_t k) {
  return k < cells.size() ? cells[k] : "";
}

bool hasUnit(const std::string& cell, std::string_view unit) {
  const std::string low = tables::lowered(cell);
  return low.size() > unit.size() && low.ends_with(unit) &&
         (std::isdigit(static_cast<unsigned char>(low.front())) != 0);
}

// The number in "1259.2593 Hz"
std::optional<double> numberBefore(const std::string& cell, std::string_view unit) {
  double value = 0;
  const std::string digits(
      tables::trimmed(std::string_view(cell).substr(0, cell.size() - unit.size())));
  if (!tables::NumberReader(true).read(digits, value).empty() || !(value > 0)) return std::nullopt;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

struct DiscoverHeader {
  std::size_t line = 0;  // of the rates, counted from 1
  std::string_view mark;
  DiscoverCells rates;
};

// Nothing but rates, and empty cells above which the times stand.
std::optional<DiscoverHeader> discoverHeader(const std::vector<std::string>& lines) {
  for (std::size_t i = 1; i < std::min(lines.size(), lastRatesLine); ++i) {
    if (tables::lowered(lines[i]).find("hz") == std::string::npos) continue;
    for (const std::string_view mark : discoverMarks) {
      DiscoverCells cells = cellsBetween(lines[i], mark);
      const auto isRate = [](const std::string& c) { return hasUnit(c, "hz"); };
      const bool only = std::all_of(cells.begin(), cells.end(),
                                    [&](const std::string& c) { return c.empty() || isRate(c); });
      const DiscoverCells names = cellsBetween(lines[i - 1], mark);
      const bool times = std::any_of(names.begin(), names.end(), [](const std::string& c) {
        return c.ends_with("(s)") || c.ends_with("[s]");
      });
      if (only && times && std::any_of(cells.begin(), cells.end(), isRate)) {
        return DiscoverHeader{i + 1, mark, std::move(cells)};
      }
    }
  }
  return std::nullopt;
}

// "EMG 1 (mV)" → "EMG 1", "mV"
std::pair<std::string, std::string> discoverUnit(const std::string& name) {
  const auto open = name.rfind('(');
  if (open == std::string::npos || !name.ends_with(')')) return {name, ""};
  return {std::string(tables::trimmed(std::string_view(name).substr(0, open))),
          name.substr(open + 1, name.size() - open - 2)};
}

// One signal and the column of its times.
struct DiscoverSignal {
  std::size_t column = 0;
  std::optional<std::size_t> timeColumn;
  RawColumn raw;
  std::vector<double> times, values;
};

class DiscoverReader {
 public:
  DiscoverReader(const std::string& file, const std::vector<std::string>& lines,
                 DiscoverHeader header, ReadingNotes& notes)
      : file_(file),
        lines_(lines),
        header_(std::move(header)),
        notes_(notes),
        numbers_(header_.mark != ",") {}

  std::vector<RawColumn> read() {
    readNames();
    const std::size_t first = readIntervals();
    for (std::size_t i = first; i < lines_.size(); ++i) readRow(i);
    if (!numbers_.undecided().empty()) {
      throw FileError(
          fmt::format("{}: '{}' and all such numbers could have a decimal comma or a comma between "
                      "thousands, must be written with a decimal point",
                      file_, numbers_.undecided()));
    }
    if (events_) notes_.remarks.emplace_back("The table of events at the right was not read.");
    std::vector<RawColumn> out;
    for (DiscoverSignal& signal : signals_) out.push_back(columnOf(signal));
    return out;
  }

 private:
  void readNames() {
    const std::size_t at = header_.line - 2;  // of the names
    const DiscoverCells names = cellsBetween(lines_[at], header_.mark);
    // "sensor mode: 40" stands between sensors and names in most versions
    const bool modes = at >= 1 && lines_[at - 1].find(':') != std::string::npos;
    const std::size_t above = modes ? 2 : 1;
    const DiscoverCells sensors =
        at >= above ? cellsBetween(lines_[at - above], header_.mark) : DiscoverCells{};
    std::map<std::string, int> uses;
    std::string sensor;
    for (std::size_t k = 0; k < std::max(names.size(), header_.rates.size()); ++k) {
      if (!cellAt(sensors, k).empty()) {
        const auto [name, serial] = discoverUnit(sensors[k]);
        sensor = uses[name]++ == 0 ? name : sensors[k];
      }
      const std::string rate = cellAt(header_.rates, k);
      if (rate.empty()) continue;
      DiscoverSignal signal;
      const auto [name, unit] = discoverUnit(cellAt(names, k));
      if (name.empty()) {
        throw FileError(
            fmt::format("{}:{}: column {}: has a rate but no name", file_, at + 1, k + 1));
      }
      const std::optional<double> stated = numberBefore(rate, "hz");
      if (!stated) {
        throw FileError(fmt::format("{}:{}: column {} '{}': rate '{}', must be a number > 0 and Hz",
                                    file_, header_.line, k + 1, name, rate));
      }
      signal.column = k;
      if (k > 0 && cellAt(header_.rates, k - 1).empty() && !cellAt(names, k - 1).empty()) {
        signal.timeColumn = k - 1;
      }
      signal.raw.number = static_cast<int>(k + 1);
      signal.raw.header = sensor.empty() ? name : sensor + " " + name;
      signal.raw.unit = unit;
      signal.raw.rate = *stated;
      signals_.push_back(std::move(signal));
    }
  }

  // The line of the first row; sample intervals, if they are there, must fit the rates.
  std::size_t readIntervals() {
    if (header_.line >= lines_.size()) return header_.line;
    const DiscoverCells cells = cellsBetween(lines_[header_.line], header_.mark);
    bool any = false;
    for (const DiscoverSignal& signal : signals_) {
      const std::string cell = cellAt(cells, signal.column);
      if (!hasUnit(cell, " s")) continue;
      any = true;
      const std::optional<double> interval = numberBefore(cell, " s");
      if (!interval || std::abs(*interval * signal.raw.rate - 1) < 0.01) continue;
      notes_.warnings.push_back(fmt::format(
          "Channel '{}': {:g} Hz in line {}, but a sample interval of {:g} s in line {}: "
          "the rate was taken.",
          signal.raw.header, signal.raw.rate, header_.line, *interval, header_.line + 1));
    }
    return any ? header_.line + 1 : header_.line;
  }

  void readRow(std::size_t i) {
    if (tables::trimmed(lines_[i]).empty()) return;
    const DiscoverCells cells = cellsBetween(lines_[i], header_.mark);
    for (DiscoverSignal& signal : signals_) {
      const std::string value = cellAt(cells, signal.column);
      if (value.empty()) continue;
      signal.values.resize(rows_, std::numeric_limits<double>::quiet_NaN());
      signal.values.push_back(number(value, i, signal.column, signal.raw.header));
      if (!signal.timeColumn || cellAt(cells, *signal.timeColumn).empty()) continue;
      signal.times.resize(rows_, std::numeric_limits<double>::quiet_NaN());
      signal.times.push_back(
          number(cells[*signal.timeColumn], i, *signal.timeColumn, signal.raw.header + ", time"));
    }
    const std::size_t width = signals_.back().column + 1;
    for (std::size_t k = width; k < cells.size(); ++k) events_ = events_ || !cells[k].empty();
    ++rows_;
  }

  double number(const std::string& cell, std::size_t line, std::size_t column,
                const std::string& name) {
    double value = 0;
    const std::string_view rule = numbers_.read(cell, value);
    if (rule.empty() && std::isfinite(value)) return value;
    throw FileError(fmt::format("{}:{}: column {} '{}': '{}' {}", file_, line + 1, column + 1, name,
                                cell, rule.empty() ? "must be finite" : rule));
  }

  RawColumn columnOf(DiscoverSignal& signal) {
    RawColumn& column = signal.raw;
    const std::vector<double>& times = signal.times;
    column.values =
        Eigen::VectorXd::Map(signal.values.data(), static_cast<Eigen::Index>(signal.values.size()));
    if (times.empty() || !std::isfinite(times.front())) return std::move(column);
    column.startTime = times.front();
    const double duration = times.back() - times.front();
    const auto intervals = static_cast<double>(times.size() - 1);
    if (intervals < 10 || std::abs(intervals / (column.rate * duration) - 1) < 0.01) {
      return std::move(column);
    }
    notes_.warnings.push_back(fmt::format(
        "Channel '{}': {:g} Hz in line {}, but its times rise at {:.6g} Hz: the rate in "
        "line {} was taken.",
        column.header, column.rate, header_.line, intervals / duration, header_.line));
    return std::move(column);
  }

  const std::string& file_;
  const std::vector<std::string>& lines_;
  DiscoverHeader header_;
  ReadingNotes& notes_;
  tables::NumberReader numbers_;
  std::vector<DiscoverSignal> signals_;
  std::size_t rows_ = 0;
  bool events_ = false;
};

}  // namespace

std::size_t discoverRates(const std::vector<std::string>& lines) {
  const std::optional<DiscoverHeader> header = discoverHeader(lines);
  return header ? header->line : 0;
}

std::vector<RawColumn> readDiscover(const std::string& file, const std::vector<std::string>& lines,
                                    ReadingNotes& notes) {
  std::optional<DiscoverHeader> header = discoverHeader(lines);
  if (!header) throw FileError(fmt::format("{}: has no line of rates in Hz", file));
  return DiscoverReader(file, lines, *std::move(header), notes).read();
}

}  // namespace bio
