#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "bio/tables/file_error.h"
#include "tables/cells.h"
#include "tables/equal_times.h"
#include "tables/recording_layouts.h"

namespace bio {
namespace {

using tables::Separator;
using ExportCells = std::vector<std::string_view>;

constexpr double noValue = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t mostHeaderLines = 1000;

constexpr std::array<Separator, 3> exportSeparators = {Separator::comma, Separator::semicolon,
                                                       Separator::tab};

bool isTimeCell(std::string_view cell) {
  const tables::TimeName name = tables::timeNameOf(cell);
  return name.isTime && name.unknownUnit.empty();
}

// "VMO RT, uV" → "VMO RT", "uV"
std::pair<std::string_view, std::string_view> splitAtComma(std::string_view cell) {
  const auto comma = cell.rfind(',');
  if (comma == cell.npos || comma == 0) return {cell, {}};
  return {tables::trimmed(cell.substr(0, comma)), tables::trimmed(cell.substr(comma + 1))};
}

// "Biceps: EMG 1 [V]" → "Biceps: EMG 1", "V"
std::pair<std::string_view, std::string_view> splitBrackets(std::string_view cell) {
  if (cell.empty() || (cell.back() != ']' && cell.back() != ')')) return {cell, {}};
  const auto open = cell.rfind(cell.back() == ']' ? '[' : '(');
  if (open == cell.npos || open == 0) return {cell, {}};
  return {tables::trimmed(cell.substr(0, open)), cell.substr(open + 1, cell.size() - open - 2)};
}

struct NamesLine {
  Separator separator;
  ExportCells cells;
};

std::optional<NamesLine> emgworksCells(const std::string& line) {
  for (const Separator separator : exportSeparators) {
    ExportCells cells = tables::splitCells(line, separator);
    const auto isX = [](std::string_view c) {
      return isTimeCell(c) && !c.empty() && (c[0] == 'X' || c[0] == 'x');
    };
    if (!cells.empty() && isX(cells[0]) && std::count_if(cells.begin(), cells.end(), isX) > 1) {
      return NamesLine{separator, std::move(cells)};
    }
  }
  return std::nullopt;
}

std::optional<NamesLine> noraxonCells(const std::string& line) {
  for (const Separator separator : exportSeparators) {
    ExportCells cells = tables::splitCells(line, separator);
    const bool hasTime = std::any_of(cells.begin(), cells.end(), isTimeCell);
    const bool hasUnit = std::any_of(cells.begin(), cells.end(), [](std::string_view c) {
      return !isTimeCell(c) && !splitAtComma(c).second.empty();
    });
    if (cells.size() > 1 && hasTime && hasUnit) return NamesLine{separator, std::move(cells)};
  }
  return std::nullopt;
}

template <class Parse>
std::size_t namesLine(const std::vector<std::string>& lines, Parse parse) {
  for (std::size_t i = 0; i < std::min(lines.size(), mostHeaderLines); ++i) {
    if (tables::trimmed(lines[i]) == "endheader") return 0;  // OpenSim's table
    if (parse(lines[i])) return i + 1;
  }
  return 0;
}

// Rows below a line of names, cell by cell.
class ExportReader {
 public:
  ExportReader(const std::string& file, std::size_t line, NamesLine names)
      : file_(file),
        first_(line),
        names_(std::move(names)),
        numbers_(names_.separator != Separator::comma) {}

  const ExportCells& names() const { return names_.cells; }
  [[noreturn]] void fail(std::size_t line, std::size_t column, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: column {} '{}': {}", file_, line, column + 1,
                                names_.cells[column], what));
  }

  /// Calls row(line, cells) for every line that is not empty.
  template <class Row>
  void forEachRow(const std::vector<std::string>& lines, Row row) {
    for (std::size_t i = first_; i < lines.size(); ++i) {
      if (tables::trimmed(lines[i]).empty()) continue;
      ExportCells cells = tables::splitCells(lines[i], names_.separator);
      while (cells.size() > names_.cells.size() && cells.back().empty()) cells.pop_back();
      if (cells.size() > names_.cells.size()) {
        throw FileError(fmt::format("{}:{}: has {} cells, must have at most {}, one per name",
                                    file_, i + 1, cells.size(), names_.cells.size()));
      }
      cells.resize(names_.cells.size());
      row(i + 1, cells);
    }
    if (!numbers_.undecided().empty()) {
      throw FileError(
          fmt::format("{}: '{}' and all such numbers could have a decimal comma or a "
                      "comma between thousands, must be written with a decimal point",
                      file_, numbers_.undecided()));
    }
  }

  bool isNumber(std::string_view cell) const {
    double value = 0;
    return tables::NumberReader(names_.separator != Separator::comma).read(cell, value).empty();
  }
  double number(std::size_t line, std::size_t column, std::string_view cell) {
    double value = 0;
    const std::string_view rule = numbers_.read(cell, value);
    if (!rule.empty()) fail(line, column, fmt::format("'{}' {}", cell, rule));
    if (!std::isfinite(value)) fail(line, column, fmt::format("'{}' must be finite", cell));
    return value;
  }

 private:
  const std::string& file_;
  std::size_t first_;  ///< lines before the rows
  NamesLine names_;
  tables::NumberReader numbers_;
};

Eigen::VectorXd vectorOf(const std::vector<double>& values) {
  return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

ExportReader exportReader(const std::string& file, const std::vector<std::string>& lines,
                          std::size_t line, std::optional<NamesLine> names, const char* rule) {
  if (line == 0 || !names) throw FileError(fmt::format("{}: has no line of names, {}", file, rule));
  const bool isBlank =
      std::all_of(lines.begin() + static_cast<std::ptrdiff_t>(line), lines.end(),
                  [](const std::string& l) { return l.find_first_not_of(" \t,;\r") == l.npos; });
  if (isBlank) throw FileError(fmt::format("{}: ends with its names, must hold rows", file));
  return {file, line, *std::move(names)};
}

// Cells of one column of texts and numbers.
struct MixedColumn {
  std::vector<double> values;
  bool anyNumber = false, anyText = false;
};

}  // namespace

std::size_t emgworksNames(const std::vector<std::string>& lines) {
  return namesLine(lines, emgworksCells);
}
std::size_t noraxonNames(const std::vector<std::string>& lines) {
  return namesLine(lines, noraxonCells);
}

std::vector<RawColumn> readEmgworks(const std::string& file, ReadingNotes& notes) {
  const std::vector<std::string> lines = linesOf(file);
  const std::size_t line = emgworksNames(lines);
  ExportReader reader =
      exportReader(file, lines, line, line > 0 ? emgworksCells(lines[line - 1]) : std::nullopt,
                   "an EMGworks export has X[s] in front of every signal");
  const std::size_t width = reader.names().size();
  std::vector<std::vector<double>> columns(width);
  std::vector<std::size_t> timeOf(width, 0);
  for (std::size_t k = 0; k < width; ++k) {
    timeOf[k] = isTimeCell(reader.names()[k]) ? k : timeOf[k > 0 ? k - 1 : 0];
  }
  std::size_t rows = 0;
  reader.forEachRow(lines, [&](std::size_t at, const ExportCells& cells) {
    for (std::size_t k = 0; k < width; ++k) {
      if (timeOf[k] == k) {
        if (cells[k].empty()) continue;
        if (columns[k].size() != rows)
          reader.fail(at, k, "a time after a row without, must be in all up to the last");
        columns[k].push_back(reader.number(at, k, cells[k]));
      } else if (!cells[k].empty()) {
        if (columns[timeOf[k]].size() != rows + 1) reader.fail(at, k, "has a value but no time");
        columns[k].resize(rows, noValue);
        columns[k].push_back(reader.number(at, k, cells[k]));
      }
    }
    ++rows;
  });
  std::vector<RawColumn> out;
  for (std::size_t k = 0; k < width; ++k) {
    if (timeOf[k] == k || (reader.names()[k].empty() && columns[k].empty())) continue;
    RawColumn column;
    const auto [name, unit] = splitBrackets(reader.names()[k]);
    if (columns[timeOf[k]].size() > 1) {
      const tables::TimeName unitOfTime = tables::timeNameOf(reader.names()[timeOf[k]]);
      const Eigen::VectorXd times =
          vectorOf(columns[timeOf[k]]) * (unitOfTime.times / unitOfTime.per);
      const RowTimes spacing =
          rowTimesOf(fmt::format("{}: column {} '{}'", file, timeOf[k] + 1, name), times);
      if (spacing.equal) {
        column.rate = spacing.rate;
        column.startTime = times[0];
        column.values = vectorOf(columns[k]);
      } else {
        columns[k].resize(columns[timeOf[k]].size(), noValue);
        column = atEqualTimes(vectorOf(columns[k]), spacing);
        notes.warnings.push_back(fmt::format("Column '{}': {}", name, jitterOf(spacing)));
      }
    } else {
      column.values = vectorOf(columns[k]);
    }
    column.number = static_cast<int>(k + 1);
    column.header = name;
    column.unit = std::string(unit);
    out.push_back(std::move(column));
  }
  return out;
}

std::vector<RawColumn> readNoraxon(const std::string& file, ReadingNotes& notes) {
  const std::vector<std::string> lines = linesOf(file);
  const std::size_t line = noraxonNames(lines);
  ExportReader reader =
      exportReader(file, lines, line, line > 0 ? noraxonCells(lines[line - 1]) : std::nullopt,
                   "a Noraxon export has a time and columns called NAME, UNIT");
  const ExportCells& names = reader.names();
  const auto time = static_cast<std::size_t>(std::find_if(names.begin(), names.end(), isTimeCell) -
                                             names.begin());
  std::vector<MixedColumn> columns(names.size());
  reader.forEachRow(lines, [&](std::size_t at, const ExportCells& cells) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      MixedColumn& column = columns[k];
      const std::string_view cell = cells[k];
      if (k == time && cell.empty()) reader.fail(at, k, "is empty, must be in every row");
      // a column of texts says so in its first cell
      const bool isText = k != time && !column.anyNumber && !cell.empty() &&
                          !reader.isNumber(cell) && splitAtComma(names[k]).second.empty();
      column.anyText = column.anyText || isText;
      if (cell.empty() || column.anyText) {
        column.values.push_back(noValue);
        continue;
      }
      column.values.push_back(reader.number(at, k, cell));
      column.anyNumber = true;
    }
  });
  const tables::TimeName unitOfTime = tables::timeNameOf(names[time]);
  const Eigen::VectorXd times =
      vectorOf(columns[time].values) * (unitOfTime.times / unitOfTime.per);
  const RowTimes rows = rowTimesOf(file, times);
  if (!rows.equal) notes.warnings.push_back(jitterOf(rows));
  std::vector<RawColumn> out;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k == time) continue;
    if (columns[k].anyText) {
      notes.remarks.push_back(fmt::format("Column '{}' holds texts and was not read.", names[k]));
      continue;
    }
    if (names[k].empty() && !columns[k].anyNumber) continue;
    RawColumn column = atEqualTimes(vectorOf(columns[k].values), rows);
    auto [name, unit] = splitAtComma(names[k]);
    if (unit.empty()) std::tie(name, unit) = splitBrackets(names[k]);
    column.number = static_cast<int>(k + 1);
    column.header = name;
    column.unit = std::string(unit);
    out.push_back(std::move(column));
  }
  return out;
}

}  // namespace bio
