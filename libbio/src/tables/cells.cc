#include "tables/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <stdexcept>

#include "bio/tables/file_error.h"
#include "tables/text_file.h"

namespace bio::tables {

bool isNumber(std::string_view digits, double& value) {
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size() && !digits.empty();
}

namespace {

bool isWhite(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

char markOf(Separator separator) {
  switch (separator) {
    case Separator::comma:
      return ',';
    case Separator::semicolon:
      return ';';
    default:
      return '\t';
  }
}

std::vector<std::string_view> splitWords(std::string_view line) {
  std::vector<std::string_view> cells;
  for (line = trimmed(line); !line.empty();) {
    const auto length = static_cast<std::size_t>(
        std::find_if(line.begin(), line.end(), isWhite) - line.begin());
    cells.push_back(line.substr(0, length));
    line = trimmed(line.substr(length));
  }
  return cells;
}

// Where a quoted cell ends: behind a quote that only blanks part from the separator or the end.
std::size_t endOfQuoted(std::string_view line, std::size_t open, char mark) {
  for (auto at = line.find('"', open + 1); at != line.npos; at = line.find('"', at + 1)) {
    const auto behind = line.find_first_not_of(mark == '\t' ? " " : " \t", at + 1);
    if (behind == line.npos || line[behind] == mark) return behind;
  }
  return open;  // is not closed
}

// "12,345": a whole number of one to three digits, not 0, before the comma, three behind it.
bool couldBeThousands(std::string_view cell) {
  if (cell.starts_with('+') || cell.starts_with('-')) cell.remove_prefix(1);
  const auto comma = cell.find(',');
  const std::string_view before = cell.substr(0, comma), behind = cell.substr(comma + 1);
  const auto digits = [](std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  };
  return !before.empty() && before.size() <= 3 && before.front() != '0' && behind.size() == 3 &&
         digits(before) && digits(behind);
}

struct TimeUnit {
  std::string_view name;
  double times, per;
};
constexpr std::array<TimeUnit, 15> timeUnits = {{{"s", 1, 1},
                                                 {"sec", 1, 1},
                                                 {"secs", 1, 1},
                                                 {"second", 1, 1},
                                                 {"seconds", 1, 1},
                                                 {"ms", 1, 1e3},
                                                 {"msec", 1, 1e3},
                                                 {"millisecond", 1, 1e3},
                                                 {"milliseconds", 1, 1e3},
                                                 {"us", 1, 1e6},
                                                 {"\xC2\xB5s", 1, 1e6},
                                                 {"\xCE\xBCs", 1, 1e6},
                                                 {"microseconds", 1, 1e6},
                                                 {"min", 60, 1},
                                                 {"minutes", 60, 1}}};

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isWhite(text.front())) text.remove_prefix(1);
  while (!text.empty() && isWhite(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return low;
}

void requireTableText(std::string_view text, const std::string& file) {
  const std::string_view start = text.substr(0, 4);
  // Without a mark, every second byte of the first letters is 0.
  const bool marked = start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF");
  const bool halfEmpty = start.size() >= 2 && (start[0] == 0) != (start[1] == 0);
  if (marked || halfEmpty) {
    throw FileError(fmt::format(
        "{}: is UTF-16, must be UTF-8 (save it as CSV UTF-8, or: iconv -f UTF-16 -t UTF-8)", file));
  }
  if (text.find('\0') != text.npos) {
    throw FileError(
        fmt::format("{}: holds bytes that are no text, must be a table in UTF-8", file));
  }
}

namespace {

bool isTextInUtf8(std::string_view text) {
  for (std::size_t k = 0; k < text.size();) {
    const auto first = static_cast<unsigned char>(text[k]);
    const int more = first < 0x80 ? 0 : first >= 0xC2 && first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    if (first >= 0x80 && (first < 0xC2 || first > 0xF4)) return false;
    for (int i = 1; i <= more; ++i) {
      if (k + static_cast<std::size_t>(i) >= text.size() ||
          (static_cast<unsigned char>(text[k + static_cast<std::size_t>(i)]) & 0xC0) != 0x80)
        return false;
    }
    k += static_cast<std::size_t>(more) + 1;
  }
  return true;
}

std::string fromLatin1(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xC0 | (byte >> 6));
      utf8 += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return utf8;
}

}  // namespace

std::string inUtf8(std::string text) {
  return isTextInUtf8(text) ? text : fromLatin1(text);
}

std::string readTableText(const std::filesystem::path& file) {
  std::string text = readTextFile(file);
  requireTableText(text, file.string());
  return inUtf8(std::move(text));
}

Lines::Lines(std::string_view text) : left_(text) {
  while (left_.starts_with(byteOrderMark)) left_.remove_prefix(byteOrderMark.size());
  if (left_.find('\n') == left_.npos) end_ = '\r';
}

bool Lines::next(std::string_view& line) {
  if (left_.empty()) return false;
  const auto end = left_.find(end_);
  line = left_.substr(0, end);
  left_ = end == left_.npos ? std::string_view{} : left_.substr(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++number_;
  return true;
}

std::vector<std::string_view> splitCells(std::string_view line, Separator separator) {
  if (separator == Separator::space) return splitWords(line);
  const char mark = markOf(separator);
  std::vector<std::string_view> cells;
  bool anyClosed = true;  // where a quote is not closed, none behind it is
  for (std::size_t begin = 0;;) {
    auto end = line.find(mark, begin);
    const auto open = line.find_first_not_of(mark == '\t' ? " " : " \t", begin);
    if (anyClosed && open < end && line[open] == '"') {
      const auto closed = endOfQuoted(line, open, mark);
      anyClosed = closed != open;
      if (anyClosed) end = closed;
    }
    std::string_view cell = trimmed(line.substr(begin, end == line.npos ? end : end - begin));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
      cell = trimmed(cell.substr(1, cell.size() - 2));
    }
    cells.push_back(cell);
    if (end == line.npos) return cells;
    begin = end + 1;
  }
}

Separator separatorOf(std::string_view names, std::string_view firstRow) {
  std::vector<Separator> found, fitting;
  for (const Separator each : {Separator::comma, Separator::semicolon, Separator::tab}) {
    const std::size_t count = splitCells(names, each).size();
    if (count < 2) continue;
    found.push_back(each);
    if (splitCells(firstRow, each).size() == count) fitting.push_back(each);
  }
  if (found.empty()) return Separator::comma;
  if (found.size() == 1) return found.front();
  if (fitting.size() == 1) return fitting.front();
  throw std::invalid_argument(
      "commas, semicolons or tabs could separate the names, must be one of them (quote names that "
      "hold another)");
}

std::string_view NumberReader::readComma(std::string_view cell, double& value) {
  const auto comma = cell.find(',');
  if (cell.find('.') != cell.npos || cell.find(',', comma + 1) != cell.npos) {
    return "must be a number without thousands separators";
  }
  std::string digits(cell);
  digits[comma] = '.';
  if (!isNumber(digits, value)) return "must be a number";
  if (!commas_) {
    return "must have a decimal point (decimal commas need semicolons or tabs between cells)";
  }
  if (decimal_ == '.') return "must have a decimal point as the cells before";
  if (decimal_ == 0) first_ = cell;
  decimal_ = ',';
  onlyThousands_ = onlyThousands_ && couldBeThousands(cell);
  return {};
}

std::string_view NumberReader::read(std::string_view cell, double& value) {
  if (cell.find(',') != cell.npos) return readComma(cell, value);
  if (!isNumber(cell, value)) return "must be a number";
  if (commas_ && cell.find('.') != cell.npos) {
    if (decimal_ == ',') return "must have a decimal comma as the cells before";
    decimal_ = '.';
  }
  return {};
}

TimeName timeNameOf(std::string_view column) {
  const std::string low = lowered(trimmed(column));
  std::string_view rest = low;
  const bool delsys = rest.starts_with("x[") || rest.starts_with("x [");
  if (!delsys && !rest.starts_with("time")) return {};
  rest.remove_prefix(delsys ? 1 : 4);
  if (rest.empty()) return {.isTime = true, .unknownUnit = {}};
  const auto begin = rest.find_first_not_of(" _,/:.");
  if (begin == rest.npos) return {};
  const bool parted = begin > 0;
  rest.remove_prefix(begin);
  const bool bracketed =
      (rest.front() == '[' && rest.back() == ']') || (rest.front() == '(' && rest.back() == ')');
  if (bracketed && rest.size() >= 2) rest = trimmed(rest.substr(1, rest.size() - 2));
  for (const TimeUnit& unit : timeUnits) {
    if (rest == unit.name && (bracketed || parted)) return {true, {}, unit.times, unit.per};
  }
  if (!bracketed || delsys) return {};
  return {.isTime = true, .unknownUnit = std::string(rest)};
}

}  // namespace bio::tables
