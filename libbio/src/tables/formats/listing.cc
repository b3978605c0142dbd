#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "bio/tables/file_error.h"
#include "bio/tables/units.h"
#include "tables/cells.h"
#include "tables/equal_times.h"
#include "tables/recording_layouts.h"

// Listings as dynamometers (Biodex, Humac) and others write them: lines about the test, a row of
// names with one of times, perhaps a row of units, rows of numbers.
namespace bio {
namespace {

using tables::Separator;
using ListingCells = std::vector<std::string_view>;

constexpr std::size_t lastNamesLine = 300;

bool isEmptyLine(const std::string& line) {
  return line.find_first_not_of(" \t,;\r\"") == std::string::npos;
}

bool isNumberCell(std::string_view cell) {
  double value = 0;
  return tables::NumberReader(true).read(cell, value).empty();
}

// Between runs of two blanks and more, so that names can hold one.
ListingCells wideCells(std::string_view line) {
  ListingCells cells;
  line = tables::trimmed(line);
  while (!line.empty()) {
    const auto end = std::min(line.find("  "), line.find('\t'));
    cells.push_back(tables::trimmed(line.substr(0, end)));
    line = end == line.npos ? std::string_view{} : tables::trimmed(line.substr(end));
  }
  return cells;
}

ListingCells cellsIn(std::string_view line, Separator separator, std::size_t width) {
  if (separator != Separator::space) {
    ListingCells cells = tables::splitCells(line, separator);
    while (cells.size() > 1 && cells.back().empty()) cells.pop_back();
    return cells;
  }
  ListingCells cells = tables::splitCells(line, separator);
  if (width == 0 || cells.size() == width) return cells;
  return wideCells(line);
}

// A time by its name alone or with a unit: "TIME", "Time (ms)", "Zeit [s]".
bool isTimeName(std::string_view cell) {
  if (tables::timeNameOf(cell).isTime) return true;
  const std::string low =
      tables::lowered(tables::trimmed(cell.substr(0, cell.find_first_of("[(,"))));
  return low == "time" || low == "timestamp" || low == "time stamp" || low == "elapsed time" ||
         low == "zeit" || low == "temps" || low == "tempo" || low == "tiempo" || low == "tijd";
}

bool isNumberRow(const ListingCells& cells, std::size_t width) {
  const auto numbers = std::count_if(cells.begin(), cells.end(), isNumberCell);
  const auto blanks =
      std::count_if(cells.begin(), cells.end(), [](std::string_view c) { return c.empty(); });
  return numbers >= 2 && numbers + blanks == static_cast<std::ptrdiff_t>(cells.size()) &&
         cells.size() <= width;
}

bool isUnitRow(const ListingCells& cells, std::size_t width) {
  if (cells.empty() || cells.size() > width) return false;
  const auto bare = [](std::string_view cell) {
    const bool bracketed = cell.size() > 2 && (cell.front() == '[' || cell.front() == '(');
    return bracketed ? cell.substr(1, cell.size() - 2) : cell;
  };
  if (std::any_of(cells.begin(), cells.end(), isNumberCell)) return false;
  return std::any_of(cells.begin(), cells.end(),
                     [&](std::string_view c) { return knownUnit(bare(c)).has_value(); });
}

struct ListingHead {
  std::size_t names = 0, rows = 0;  // lines counted from 0
  bool hasUnits = false;
  Separator separator = Separator::space;
  ListingCells cells, units;
};

std::size_t nextFilled(const std::vector<std::string>& lines, std::size_t i) {
  while (i < lines.size() && isEmptyLine(lines[i])) ++i;
  return i;
}

std::optional<ListingHead> headAt(const std::vector<std::string>& lines, std::size_t i) {
  for (const Separator separator :
       {Separator::tab, Separator::semicolon, Separator::comma, Separator::space}) {
    const std::size_t next = nextFilled(lines, i + 1);
    if (next >= lines.size()) return std::nullopt;
    const std::size_t afterUnits = nextFilled(lines, next + 1);
    for (const bool units : {false, true}) {
      const std::size_t row = units ? afterUnits : next;
      if (row >= lines.size()) continue;
      ListingHead head{.names = i,
                       .rows = row,
                       .hasUnits = units,
                       .separator = separator,
                       .cells = {},
                       .units = {}};
      const std::size_t width =
          separator == Separator::space ? cellsIn(lines[row], separator, 0).size() : 0;
      head.cells = cellsIn(lines[i], separator, width);
      const bool fits = separator != Separator::space || head.cells.size() == width;
      const bool hasTime = std::any_of(head.cells.begin(), head.cells.end(), isTimeName);
      if (head.cells.size() < 2 || !fits || !hasTime ||
          std::any_of(head.cells.begin(), head.cells.end(), isNumberCell)) {
        continue;
      }
      if (units) head.units = cellsIn(lines[next], separator, head.cells.size());
      if (units && !isUnitRow(head.units, head.cells.size())) continue;
      if (isNumberRow(cellsIn(lines[row], separator, 0), head.cells.size())) return head;
    }
  }
  return std::nullopt;
}

std::optional<ListingHead> listingHead(const std::vector<std::string>& lines) {
  bool before = false;
  for (std::size_t i = 0; i < std::min(lines.size(), lastNamesLine); ++i) {
    if (tables::lowered(tables::trimmed(lines[i])) == "endheader") return std::nullopt;
    if (isEmptyLine(lines[i])) continue;
    const std::optional<ListingHead> head = headAt(lines, i);
    if (head) {
      const bool plain = !before && !head->hasUnits && head->separator != Separator::space;
      return plain ? std::nullopt : head;
    }
    before = before || !tables::lowered(lines[i]).starts_with("sep=");
  }
  return std::nullopt;
}

class ListingReader {
 public:
  ListingReader(const std::string& file, const std::vector<std::string>& lines, ListingHead head,
                ReadingNotes& notes)
      : file_(file),
        lines_(lines),
        head_(std::move(head)),
        notes_(notes),
        numbers_(head_.separator != Separator::comma) {}

  std::vector<RawColumn> read() {
    const auto found = std::find_if(head_.cells.begin(), head_.cells.end(), isTimeName);
    time_ = static_cast<std::size_t>(found - head_.cells.begin());
    values_.resize(head_.cells.size());
    std::size_t i = head_.rows;
    for (; i < lines_.size(); ++i) {
      if (!isEmptyLine(lines_[i]) && !readRow(i)) break;
    }
    tellRest(i);
    if (!numbers_.undecided().empty()) {
      throw FileError(
          fmt::format("{}: '{}' and all such numbers could have a decimal comma or a comma "
                      "between thousands, must be written with a decimal point",
                      file_, numbers_.undecided()));
    }
    const Eigen::VectorXd times = secondsPerUnit() * vector(time_);
    const RowTimes rows = rowTimesOf(file_, times);
    if (!rows.equal) notes_.warnings.push_back(jitterOf(rows));
    std::vector<RawColumn> out;
    for (std::size_t k = 0; k < head_.cells.size(); ++k) {
      if (k == time_) continue;
      RawColumn column = atEqualTimes(vector(k), rows);
      column.number = static_cast<int>(k + 1);
      column.header = head_.cells[k];
      column.unit = unitOf(k);
      out.push_back(std::move(column));
    }
    return out;
  }

 private:
  Eigen::VectorXd vector(std::size_t k) const {
    return Eigen::VectorXd::Map(values_[k].data(), static_cast<Eigen::Index>(values_[k].size()));
  }
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", file_, line + 1, what));
  }

  // False where the table ends: at a line without numbers, or where times begin anew.
  bool readRow(std::size_t i) {
    const ListingCells cells = cellsIn(lines_[i], head_.separator, 0);
    const bool any = std::any_of(cells.begin(), cells.end(), isNumberCell);
    if (!any) return false;
    if (cells.size() > head_.cells.size() ||
        (head_.separator == Separator::space && cells.size() != head_.cells.size())) {
      fail(i, fmt::format("has {} cells, must have {}, one per name in line {}", cells.size(),
                          head_.cells.size(), head_.names + 1));
    }
    std::vector<double> row(head_.cells.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (cells[k].empty() || tables::lowered(cells[k]) == "nan") continue;
      const std::string_view rule = numbers_.read(cells[k], row[k]);
      if (rule.empty() && std::isfinite(row[k])) continue;
      fail(i, fmt::format("column {} '{}': '{}' {}", k + 1, head_.cells[k], cells[k],
                          rule.empty() ? "must be finite" : rule));
    }
    if (std::isnan(row[time_])) fail(i, fmt::format("'{}' is empty", head_.cells[time_]));
    if (!values_[time_].empty() && row[time_] < values_[time_].back()) return false;
    for (std::size_t k = 0; k < row.size(); ++k) values_[k].push_back(row[k]);
    return true;
  }

  void tellRest(std::size_t from) const {
    std::size_t rest = 0;
    for (std::size_t i = from; i < lines_.size(); ++i) rest += isEmptyLine(lines_[i]) ? 0 : 1;
    if (rest == 0) return;
    notes_.warnings.push_back(fmt::format(
        "The table ends before line {} ('{:.40}'); {} lines from there on were not read.", from + 1,
        lines_[from], rest));
  }

  std::string unitOf(std::size_t k) const {
    std::string_view below = k < head_.units.size() ? head_.units[k] : std::string_view{};
    if (below.size() > 2 && (below.front() == '[' || below.front() == '(')) {
      below = below.substr(1, below.size() - 2);
    }
    const std::string inName = unitInName(std::string(head_.cells[k]));
    if (below.empty()) return inName;
    if (!inName.empty() && !areSameUnit(inName, below)) {
      fail(head_.names + 1,
           fmt::format("'{}' is in '{}', but its name says '{}'", head_.cells[k], below, inName));
    }
    return std::string(below);
  }

  double secondsPerUnit() const {
    const tables::TimeName name = tables::timeNameOf(head_.cells[time_]);
    const std::string unit = unitOf(time_);
    if (unit.empty()) return name.times / name.per;
    const auto known = knownUnit(unit);
    if (!known || known->si != "s") {
      fail(head_.names,
           fmt::format("'{}' is in '{}', must be in s, ms, us or min", head_.cells[time_], unit));
    }
    return known->factor;
  }

  const std::string& file_;
  const std::vector<std::string>& lines_;
  ListingHead head_;
  ReadingNotes& notes_;
  tables::NumberReader numbers_;
  std::size_t time_ = 0;
  std::vector<std::vector<double>> values_;
};

}  // namespace

std::size_t listingNames(const std::vector<std::string>& lines) {
  const std::optional<ListingHead> head = listingHead(lines);
  return head ? head->names + 1 : 0;
}

std::vector<RawColumn> readListing(const std::string& file, ReadingNotes& notes) {
  const std::vector<std::string> lines = linesOf(file);
  std::optional<ListingHead> head = listingHead(lines);
  if (!head) {
    throw FileError(fmt::format(
        "{}: has no row of names with one of times above rows of numbers, a listing needs one",
        file));
  }
  return ListingReader(file, lines, *std::move(head), notes).read();
}

}  // namespace bio
