#include "bio/tables/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>

#include "bio/tables/file_error.h"
#include "tables/text_file.h"

namespace bio {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto isSpace = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return low;
}

constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";

// The lines of a text with their numbers; a line may end in CR LF, the text may begin with BOMs.
class Lines {
 public:
  explicit Lines(std::string_view text) : left_(text) {
    while (left_.starts_with(byteOrderMark)) left_.remove_prefix(byteOrderMark.size());
  }
  bool next(std::string_view& line) {
    if (left_.empty()) return false;
    const auto end = left_.find('\n');
    line = left_.substr(0, end);
    left_ = end == std::string_view::npos ? std::string_view{} : left_.substr(end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  std::string_view left_;
  int number_ = 0;
};

enum class Separator { comma, tab, space };

std::vector<std::string_view> splitCells(std::string_view line, Separator separator) {
  std::vector<std::string_view> cells;
  if (separator == Separator::space) {
    for (line = trimmed(line); !line.empty();) {
      const auto end = std::find_if(line.begin(), line.end(), [](char c) {
        return std::isspace(static_cast<unsigned char>(c)) != 0;
      });
      cells.emplace_back(line.begin(), end);
      line = trimmed(std::string_view(end, line.end()));
    }
    return cells;
  }
  const char mark = separator == Separator::comma ? ',' : '\t';
  for (;;) {
    const auto end = line.find(mark);
    std::string_view cell = trimmed(line.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
      cell = trimmed(cell.substr(1, cell.size() - 2));
    }
    cells.push_back(cell);
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

struct Reader {
  std::string file;
  Lines lines;
  Table table;
  int expectedRows = -1;
  int expectedColumns = -1;

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
  void readNames(std::string_view line, Separator separator);
  void readRows(Separator separator);
  double readCell(std::string_view cell, std::size_t column) const;
  void checkTime() const;
};

void Reader::readHeaderLine(std::string_view line, bool isFirst) {
  // OpenSim writes key=value, SIMM wrote "key value".
  auto mark = line.find('=');
  if (mark == std::string_view::npos && !isFirst) mark = line.find_first_of(" \t");
  if (mark == std::string_view::npos) {
    if (isFirst) table.name = line;
    return;
  }
  const std::string key(trimmed(line.substr(0, mark)));
  const std::string_view value = trimmed(line.substr(mark + 1));
  const std::string low = lowered(key);
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
  if (separator == Separator::tab && names.size() > 1 && names.back().empty()) names.pop_back();
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

double Reader::readCell(std::string_view cell, std::size_t column) const {
  const std::string low = lowered(cell);
  if (low.empty() || low == "nan") return std::numeric_limits<double>::quiet_NaN();
  const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(fmt::format("column '{}': value = '{}', must be a number", table.columns[column], cell));
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("column '{}': value = {}, must be finite, or empty for not measured",
                     table.columns[column], cell));
  }
  return value;
}

void Reader::readRows(Separator separator) {
  std::vector<double> cells;
  std::vector<int> rowLines;
  const std::size_t width = table.columns.size();
  const auto time = std::find_if(table.columns.begin(), table.columns.end(),
                                 [](const auto& c) { return c == "time" || c == "time_s"; });
  const auto timeColumn = static_cast<std::size_t>(time - table.columns.begin());
  int rows = 0;
  double lastTime = -std::numeric_limits<double>::infinity();
  for (std::string_view line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    auto row = splitCells(line, separator);
    if (separator == Separator::tab && row.size() == width + 1 && row.back().empty())
      row.pop_back();
    if (row.size() != width) {
      fail(fmt::format("row has {} cells, must have {} as there are columns", row.size(), width));
    }
    for (std::size_t i = 0; i < width; ++i) cells.push_back(readCell(row[i], i));
    if (timeColumn < width) {
      const double t = cells[cells.size() - width + timeColumn];
      if (!std::isfinite(t))
        fail(fmt::format("{} = '{}', must be a number", *time, row[timeColumn]));
      if (!(t > lastTime)) {
        fail(fmt::format("{} = {} s after {} s, must rise strictly", *time, t, lastTime));
      }
      lastTime = t;
    }
    ++rows;
  }
  if (rows == 0) fail("holds no rows, must hold at least one");
  if (expectedRows >= 0 && rows != expectedRows) {
    fail(fmt::format("{} rows, the header promises {}", rows, expectedRows));
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  table.values = Eigen::Map<const RowMajor>(cells.data(), rows, static_cast<Eigen::Index>(width));
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
  const std::string text = readTextFile(file);
  Reader reader{file.string(), Lines(text), {}};
  if (trimmed(text).empty()) throw FileError(file.string() + ": is empty, must be a table");

  const std::string extension = lowered(file.extension().string());
  const bool hasHeader = extension == ".sto" || extension == ".mot" ||
                         (extension != ".csv" && text.find("endheader") != std::string::npos);
  if (hasHeader) reader.readHeader();
  std::string_view names;
  while (reader.lines.next(names) && trimmed(names).empty()) {
  }
  if (trimmed(names).empty()) reader.fail("holds no column names, must hold a row of them");
  const Separator separator = !hasHeader && names.find(',') != std::string_view::npos
                                  ? Separator::comma
                              : names.find('\t') != std::string_view::npos ? Separator::tab
                              : hasHeader                                  ? Separator::space
                                                                           : Separator::comma;
  reader.readNames(names, separator);
  if (kind == TableKind::timeSeries && !hasColumn(reader.table, "time") &&
      !hasColumn(reader.table, "time_s")) {
    reader.fail("has no column 'time', must have one");
  }
  reader.readRows(separator);
  return std::move(reader.table);
}

void writeTable(const Table& table, const std::filesystem::path& file) {
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
  writeTextFile(file, fmt::to_string(text));
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
