#include "bio/tables/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>

#include "bio/tables/file_error.h"
#include "bio/tables/table_text.h"
#include "tables/cells.h"
#include "tables/formats/foreign_format.h"
#include "tables/text_file.h"

namespace bio {
namespace {

using tables::byteOrderMark;
using tables::Lines;
using tables::lowered;
using tables::NumberReader;
using tables::Separator;
using tables::splitCells;
using tables::trimmed;

struct Reader {
  std::string file;
  Lines lines;
  Table table;
  NumberReader numbers{false};
  int expectedRows = -1;
  int expectedColumns = -1;
  std::size_t blankNames = 0;  ///< separators without a name behind the last name
  tables::TimeName time = {};  ///< unit of the column `time`
  std::map<std::string, std::pair<std::string, int>> said = {};  ///< value and line by key

  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(fmt::format("{}:{}: {}", file, lines.number(), message));
  }

  int count(std::string_view key, std::string_view value) const {
    int number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || number < 0) {
      fail(fmt::format("header: {} = '{}', must be a whole number ≥ 0", key, value));
    }
    return number;
  }

  void readHeader();
  void readHeaderLine(std::string_view line, bool isFirst);
  void checkOnce(const std::string& low, std::string_view key, std::string_view value);
  void readNames(std::string_view line, Separator separator);
  void findTime();
  void readRows(Separator separator);
  void checkWidth(std::vector<std::string_view>& row, Separator separator) const;
  void checkHoldsNumbers(const std::vector<std::string_view>& row);
  double readCell(std::string_view cell, std::size_t column);
  double timeIn(std::string_view cell, double value, double lastTime,
                const std::string& name) const;
};

// What a header says twice it must say alike; free text between keys may begin alike.
void Reader::checkOnce(const std::string& low, std::string_view key, std::string_view value) {
  const bool isKey = key.find_first_of(" \t") == key.npos && !key.empty();
  if (!isKey) return;
  const auto [before, isNew] = said.try_emplace(low, std::string(value), lines.number());
  if (isNew || lowered(before->second.first) == lowered(value)) return;
  fail(fmt::format("header: {} = '{}', but line {} says '{}', must be said once", key, value,
                   before->second.second, before->second.first));
}

void Reader::readHeaderLine(std::string_view line, bool isFirst) {
  // OpenSim writes key=value, SIMM wrote "key value".
  auto mark = line.find('=');
  const bool hasEquals = mark != std::string_view::npos;
  if (mark == std::string_view::npos && !isFirst) mark = line.find_first_of(" \t");
  if (mark == std::string_view::npos) {
    if (isFirst) table.name = line;
    return;
  }
  const std::string key(trimmed(line.substr(0, mark)));
  const std::string_view value = trimmed(line.substr(mark + 1));
  const std::string low = lowered(key);
  if (hasEquals || low == "nrows" || low == "ncolumns" || low == "datarows" ||
      low == "datacolumns" || low == "indegrees") {
    checkOnce(low, key, value);
  }
  if (low == "nrows" || low == "datarows") {
    expectedRows = count(key, value);
  } else if (low == "ncolumns" || low == "datacolumns") {
    expectedColumns = count(key, value);
  } else if (low == "indegrees") {
    const std::string answer = lowered(value);
    if (answer != "yes" && answer != "no") {
      fail(fmt::format("header: inDegrees = '{}', must be yes or no", value));
    }
    table.inDegrees = answer == "yes";
  } else if (low == "datatype" && lowered(value) != "double") {
    fail(fmt::format("header: DataType = '{}', must be double", value));
  } else {
    table.metadata[key] = value;
  }
}

void Reader::readHeader() {
  bool isFirst = true;
  for (std::string_view line; lines.next(line);) {
    line = trimmed(line);
    if (lowered(line) == "endheader") return;
    if (!line.empty()) readHeaderLine(line, isFirst);
    isFirst = false;
  }
  fail("the header has no line 'endheader', must end with one");
}

void Reader::readNames(std::string_view line, Separator separator) {
  std::set<std::string_view> seen;
  auto names = splitCells(line, separator);
  // spreadsheets end every row with the separators of their widest
  while (separator != Separator::space && names.size() > 1 && names.back().empty()) {
    names.pop_back();
    ++blankNames;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) fail(fmt::format("column {} has no name, must have one", i + 1));
    if (!seen.insert(names[i]).second) {
      fail(fmt::format("second column called '{}', names must be unique", names[i]));
    }
    table.columns.emplace_back(names[i]);
  }
  if (expectedColumns >= 0 && names.size() != static_cast<std::size_t>(expectedColumns)) {
    fail(fmt::format("{} column names, the header promises {}", names.size(), expectedColumns));
  }
}

// The column of times is called `time` from here on, whatever its unit was.
void Reader::findTime() {
  if (hasColumn(table, "time") || hasColumn(table, "time_s")) return;
  std::string found;
  for (std::string& column : table.columns) {
    const tables::TimeName name = tables::timeNameOf(column);
    if (!name.isTime) continue;
    if (!name.unknownUnit.empty()) {
      fail(fmt::format("column '{}': unit '{}', must be s, ms, us or min for a time", column,
                       name.unknownUnit));
    }
    if (!found.empty()) fail(fmt::format("'{}' and '{}' are times, must be one", found, column));
    found = column;
    time = name;
    column = "time";
  }
  if (found.empty()) {
    fail("has no column 'time', must have one, in s or with its unit, 'time [ms]'" +
         tables::looksLike(file));
  }
}

double Reader::readCell(std::string_view cell, std::size_t column) {
  if (cell.empty() || (cell.size() == 3 && lowered(cell) == "nan")) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double value = 0;
  const std::string_view rule = numbers.read(cell, value);
  if (!rule.empty()) {
    fail(fmt::format("column '{}': value = '{}', {}", table.columns[column], cell, rule));
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("column '{}': value = {}, must be finite, or empty for not measured",
                     table.columns[column], cell));
  }
  return value;
}

// One cell per name; more where the names ended in separators, too, and they are empty.
void Reader::checkWidth(std::vector<std::string_view>& row, Separator separator) const {
  const std::size_t width = table.columns.size();
  const std::size_t blank = std::max<std::size_t>(blankNames, separator == Separator::tab ? 1 : 0);
  while (row.size() > width && row.size() <= width + blank && row.back().empty()) row.pop_back();
  if (row.size() > width && row.size() <= width + blankNames) {
    fail(fmt::format("column {} has values but no name, must have one", row.size()));
  }
  if (row.size() == width) return;
  const bool decimals = separator == Separator::comma && row.size() == 2 * width;
  fail(fmt::format("row has {} cells, must have {} as there are columns{}", row.size(), width,
                   decimals ? " (decimal commas need semicolons or tabs between cells)" : ""));
}

// Many programs write units in a second row.
void Reader::checkHoldsNumbers(const std::vector<std::string_view>& row) {
  double ignored = 0;
  const bool any = std::any_of(row.begin(), row.end(), [&](std::string_view cell) {
    return cell.empty() || lowered(cell) == "nan" || NumberReader(true).read(cell, ignored).empty();
  });
  if (any || row.size() < 2) return;
  fail(
      fmt::format("'{}' and every other cell is no number, must be one (a second row of names or "
                  "units? delete it and write units into the names, 'time [ms]')",
                  row.front()));
}

double Reader::timeIn(std::string_view cell, double value, double lastTime,
                      const std::string& name) const {
  if (!std::isfinite(value)) fail(fmt::format("{} = '{}', must be a number", name, cell));
  const double t = value * time.times / time.per;
  if (!(t > lastTime)) {
    fail(fmt::format("{} = {} s after {} s, must rise strictly", name, t, lastTime));
  }
  return t;
}

void Reader::readRows(Separator separator) {
  std::vector<double> cells;
  const std::size_t width = table.columns.size();
  const auto timeName = std::find_if(table.columns.begin(), table.columns.end(),
                                     [](const auto& c) { return c == "time" || c == "time_s"; });
  const auto timeColumn = static_cast<std::size_t>(timeName - table.columns.begin());
  numbers = NumberReader(separator == Separator::semicolon || separator == Separator::tab);
  int rows = 0;
  int undecidedLine = 0;
  double lastTime = -std::numeric_limits<double>::infinity();
  int emptyLine = 0;  // spreadsheets leave such rows at the end
  for (std::string_view line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    auto row = splitCells(line, separator);
    checkWidth(row, separator);
    const bool isEmpty = std::all_of(row.begin(), row.end(), [](auto c) { return c.empty(); });
    if (isEmpty && timeColumn < width && rows > 0) {
      if (emptyLine == 0) emptyLine = lines.number();
      continue;
    }
    if (emptyLine > 0) {
      throw FileError(fmt::format("{}:{}: {} = '', must be a number", file, emptyLine, *timeName));
    }
    if (rows == 0) checkHoldsNumbers(row);
    for (std::size_t i = 0; i < width; ++i) cells.push_back(readCell(row[i], i));
    if (timeColumn < width) {
      double& t = cells[cells.size() - width + timeColumn];
      lastTime = t = timeIn(row[timeColumn], t, lastTime, *timeName);
    }
    if (undecidedLine == 0 && !numbers.undecided().empty()) undecidedLine = lines.number();
    ++rows;
  }
  if (rows == 0) fail("holds no rows, must hold at least one");
  if (!numbers.undecided().empty()) {
    throw FileError(fmt::format(
        "{}:{}: '{}' and all such numbers could have a decimal comma or a comma between "
        "thousands, must be written with a decimal point or other digits",
        file, undecidedLine, numbers.undecided()));
  }
  if (expectedRows >= 0 && rows != expectedRows) {
    fail(fmt::format("{} rows, the header promises {}", rows, expectedRows));
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.values = Eigen::Map<const RowMajor>(cells.data(), rows, static_cast<Eigen::Index>(width));
}

// The next line with anything in it.
std::string_view firstFilled(Lines lines) {
  std::string_view line;
  while (lines.next(line) && trimmed(line).empty()) line = {};
  return line;
}

bool isCsv(const std::filesystem::path& file) {
  return lowered(file.extension().string()) == ".csv";
}

// Name and value of a header line that would not come back as it was.
void checkWritable(const Table& table, const std::string& file) {
  const auto fail = [&](const std::string& m) { throw FileError(file + ": " + m); };
  if (table.values.cols() != static_cast<Eigen::Index>(table.columns.size())) {
    fail(fmt::format("{} columns of values, must be {} as there are names", table.values.cols(),
                     table.columns.size()));
  }
  const std::string first = table.columns.empty() ? "" : table.columns.front();
  for (const std::string& name : {table.name, first}) {
    if (name.starts_with(byteOrderMark))
      fail(fmt::format("name '{}', must not begin with a byte order mark", name));
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& name = table.columns[i];
    if (name.empty() || name.find_first_of("\t\r\n,\"") != std::string::npos ||
        trimmed(name).size() != name.size()) {
      fail(fmt::format(
          "column name '{}', must be without tab, comma or quote, and begin and end with no space",
          name));
    }
    if (!seen.insert(name).second) fail(fmt::format("second column called '{}'", name));
    for (Eigen::Index r = 0; r < table.values.rows(); ++r) {
      if (std::isinf(table.values(r, static_cast<Eigen::Index>(i)))) {
        fail(fmt::format("column '{}' row {} = inf, must be finite or NaN", name, r + 1));
      }
    }
  }
}

}  // namespace

Table readTable(const std::filesystem::path& file, TableKind kind) {
  const std::string text = tables::readTableText(file);
  Reader reader{.file = file.string(), .lines = Lines(text), .table = {}};
  if (trimmed(text).empty()) throw FileError(file.string() + ": is empty, must be a table");

  const std::string extension = lowered(file.extension().string());
  const bool hasHeader = extension == ".sto" || extension == ".mot" ||
                         (extension != ".csv" && text.find("endheader") != std::string::npos);
  if (hasHeader) reader.readHeader();
  std::string_view names;
  // Excel's own first line says which separator follows
  while (reader.lines.next(names) &&
         (trimmed(names).empty() || (!hasHeader && lowered(names).starts_with("sep=")))) {
    names = {};
  }
  if (trimmed(names).empty()) reader.fail("holds no column names, must hold a row of them");
  Separator separator = Separator::space;
  if (!hasHeader) {
    try {
      separator = tables::separatorOf(names, firstFilled(reader.lines));
    } catch (const std::invalid_argument& rule) {
      reader.fail(rule.what());
    }
  } else if (names.find('\t') != std::string_view::npos) {
    separator = Separator::tab;
  }
  reader.readNames(names, separator);
  if (kind == TableKind::timeSeries) reader.findTime();
  reader.readRows(separator);
  return std::move(reader.table);
}

std::string tableText(const Table& table, const std::filesystem::path& file) {
  checkWritable(table, file.string());
  const bool csv = isCsv(file);
  const char separator = csv ? ',' : '\t';
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (!csv) {
    fmt::format_to(out, "{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees={}\n",
                   table.name.empty() ? "table" : table.name, table.values.rows(),
                   table.values.cols(), table.inDegrees ? "yes" : "no");
    for (const auto& [key, value] : table.metadata) {
      if (key != "version") fmt::format_to(out, "{}={}\n", key, value);
    }
    fmt::format_to(out, "endheader\n");
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text.push_back(separator);
    fmt::format_to(out, "{}", table.columns[i]);
  }
  text.push_back('\n');
  for (Eigen::Index r = 0; r < table.values.rows(); ++r) {
    for (Eigen::Index c = 0; c < table.values.cols(); ++c) {
      if (c > 0) text.push_back(separator);
      const double value = table.values(r, c);
      if (std::isnan(value)) {
        fmt::format_to(out, "{}", csv ? "" : "NaN");
      } else {
        fmt::format_to(out, "{}", value);
      }
    }
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

void writeTable(const Table& table, const std::filesystem::path& file) {
  writeTextFile(file, tableText(table, file));
}

bool hasColumn(const Table& table, const std::string& column) {
  return std::find(table.columns.begin(), table.columns.end(), column) != table.columns.end();
}

Eigen::Index columnIndex(const Table& table, const std::string& column) {
  const auto at = std::find(table.columns.begin(), table.columns.end(), column);
  if (at == table.columns.end()) {
    throw std::invalid_argument(fmt::format("the table has no column '{}' (it has: {})", column,
                                            fmt::join(table.columns, ", ")));
  }
  return at - table.columns.begin();
}

Eigen::VectorXd timesOf(const Table& table) {
  return table.values.col(columnIndex(table, hasColumn(table, "time") ? "time" : "time_s"));
}

}  // namespace bio
