#include "tables/recording_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "bio/tables/file_error.h"
#include "tables/cells.h"

namespace bio {
namespace {

constexpr double emptyCell = std::numeric_limits<double>::quiet_NaN();

/// Without blanks and quotes at its ends.
std::string unquoted(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

bool parse(const std::string& cell, double& value) {
  const char* begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end && begin != end;
}

// Cell k of a line, empty beyond its end.
std::string cell(const std::vector<std::string>& cells, std::size_t k) {
  return k < cells.size() ? cells[k] : "";
}

// "EMG 1 (mV)" → "EMG 1", "mV"
std::pair<std::string, std::string> splitUnit(const std::string& text) {
  const auto open = text.rfind('(');
  if (open == std::string::npos || !text.ends_with(')')) return {text, ""};
  return {unquoted(text.substr(0, open)), text.substr(open + 1, text.size() - open - 2)};
}

}  // namespace

std::vector<std::string> linesOf(const std::string& file) {
  const std::string text = tables::readTableText(file);
  std::vector<std::string> lines;
  tables::Lines all(text);
  for (std::string_view line; all.next(line);) lines.emplace_back(line);
  if (lines.empty()) throw FileError(fmt::format("{}: is empty, expected a recording", file));
  return lines;
}

std::vector<std::string> cellsOf(const std::string& line, char separator) {
  std::vector<std::string> cells;
  if (separator == ' ') {  // any run of spaces and tabs
    std::istringstream words(line);
    for (std::string word; words >> word;) cells.push_back(word);
    return cells;
  }
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = line.find(separator, begin);
    cells.push_back(unquoted(line.substr(begin, end - begin)));
    if (end == std::string::npos) return cells;
    begin = end + 1;
  }
}

double finiteNumber(const std::string& file, std::size_t line, const std::string& column,
                    const std::string& cell) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw FileError(
        fmt::format("{}:{}: {} = '{}', must be a finite number", file, line, column, cell));
  }
  return value;
}

bool isNumber(const std::string& text) {
  double value = 0;
  return parse(text, value) && std::isfinite(value);
}

std::vector<RawColumn> numberColumns(const std::string& file, const std::vector<std::string>& lines,
                                     std::size_t firstLine, char separator) {
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> lengths;  // up to the last value
  tables::NumberReader numbers(separator == ';' || separator == '\t');
  std::size_t width = 0;  // of the shortest line so far
  for (std::size_t i = firstLine - 1; i < lines.size(); ++i) {
    const std::size_t row = i + 1 - firstLine;
    const std::vector<std::string> cells = cellsOf(lines[i], separator);
    if (row == 0) width = cells.size();
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (cells[k].empty()) continue;
      // Where cells are not separated, nobody can tell which row a value belongs to.
      if (k >= width) {
        throw FileError(
            fmt::format("{}:{}: column {}: '{}' after a line that ends before this column, a "
                        "column must have no gaps",
                        file, i + 1, k + 1, cells[k]));
      }
      double value = 0;
      const std::string_view rule = numbers.read(cells[k], value);
      if (!rule.empty() || !std::isfinite(value)) {
        throw FileError(fmt::format("{}:{}: column {}: '{}' is not a number{}{}", file, i + 1,
                                    k + 1, cells[k],
                                    rule.empty() || rule == "must be a number" ? "" : ", ",
                                    rule == "must be a number" ? "" : rule));
      }
      if (k >= columns.size()) {
        columns.resize(k + 1);
        lengths.resize(k + 1, 0);
      }
      columns[k].resize(row, emptyCell);
      columns[k].push_back(value);
      lengths[k] = row + 1;
    }
    width = std::min(width, cells.size());
  }
  if (!numbers.undecided().empty()) {
    throw FileError(fmt::format(
        "{}: '{}' and all such numbers could have a decimal comma or a comma between thousands, "
        "must be written with a decimal point or other digits",
        file, numbers.undecided()));
  }
  std::vector<RawColumn> out;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    RawColumn column;
    column.number = static_cast<int>(k + 1);
    column.values = Eigen::VectorXd::Map(columns[k].data(), static_cast<Eigen::Index>(lengths[k]));
    out.push_back(std::move(column));
  }
  return out;
}

std::vector<RawColumn> readPlainColumns(const std::string& file) {
  const std::vector<std::string> lines = linesOf(file);
  const auto first = std::find_if(lines.begin(), lines.end(),
                                  [](const std::string& line) { return !unquoted(line).empty(); });
  if (first == lines.end()) throw FileError(fmt::format("{}: holds no numbers", file));
  char separator = ' ';
  for (const char candidate : {'\t', ';', ','}) {
    if (first->find(candidate) != std::string::npos) {
      separator = candidate;
      break;
    }
  }
  return numberColumns(file, lines, static_cast<std::size_t>(first - lines.begin()) + 1, separator);
}

std::vector<RawColumn> readTrigno(const std::string& file, ReadingNotes& notes) {
  const std::vector<std::string> lines = linesOf(file);
  if (discoverRates(lines) > 0) return readDiscover(file, lines, notes);
  if (lines.size() < 8) {
    throw FileError(
        fmt::format("{}: has {} lines, a Trigno export has 7 header lines and then values", file,
                    lines.size()));
  }
  const std::vector<std::string> sensors = cellsOf(lines[3], ',');
  const std::vector<std::string> quantities = cellsOf(lines[5], ',');
  const std::vector<std::string> rates = cellsOf(lines[6], ',');
  std::vector<RawColumn> columns = numberColumns(file, lines, 8, ',');
  std::map<std::string, int> uses;
  std::string sensor;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    RawColumn& column = columns[k];
    // a sensor's name stands above the first of its columns
    if (!cell(sensors, k).empty()) {
      const auto [name, serial] = splitUnit(cell(sensors, k));
      sensor = uses[name]++ == 0 ? name : fmt::format("{} ({})", name, serial);
    }
    const auto [quantity, unit] = splitUnit(cell(quantities, k));
    if (quantity.empty()) {
      throw FileError(fmt::format("{}:6: column {}: has values but no name", file, k + 1));
    }
    column.header = sensor.empty() ? quantity : sensor + " " + quantity;
    column.unit = unit;
    // "2148.1481 Hz"
    std::string rate = cell(rates, k);
    if (rate.ends_with("Hz")) rate = unquoted(rate.substr(0, rate.size() - 2));
    if (!parse(rate, column.rate) || !(column.rate > 0) || !std::isfinite(column.rate)) {
      throw FileError(fmt::format("{}:7: column {} '{}': rate '{}', must be a number > 0 and Hz",
                                  file, k + 1, column.header, cell(rates, k)));
    }
  }
  return columns;
}

}  // namespace bio
