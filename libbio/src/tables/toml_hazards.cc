#include "tables/toml_hazards.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "bio/tables/file_error.h"

namespace bio {
namespace {

// A line without comments and what stands in quotes; nothing if a text of several lines begins.
std::optional<std::string> codeOf(std::string_view line) {
  std::string code;
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == '"' && c == '\\') {
      ++i;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '#') {
      break;
    } else if (c == '"' || c == '\'') {
      if (line.substr(i, 3) == std::string(3, c)) return std::nullopt;
      quote = c;
    } else {
      code += c;
    }
  }
  return code;
}

// Whether a text is UTF-8: no stray or missing byte, nothing longer than need be, no half of a
// pair, nothing beyond U+10FFFF.
bool isUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t at) {
      return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
    };
    const unsigned lead = byte(i);
    const std::size_t length = lead < 0x80   ? 1
                               : lead < 0xC2 ? 0
                               : lead < 0xE0 ? 2
                               : lead < 0xF0 ? 3
                               : lead < 0xF5 ? 4
                                             : 0;
    if (length == 0) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xC0) != 0x80) return false;
    }
    const unsigned second = byte(i + 1);
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
        (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) {
      return false;
    }
    i += length;
  }
  return true;
}

// "a . 'b.c'" → a, b.c; a part with a backslash may be any name: "*".
std::vector<std::string> partsOf(std::string_view key) {
  std::vector<std::string> parts(1);
  char quote = 0;
  for (const char c : key) {
    if (quote != 0 && c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else if (quote == 0 && c == '.') {
      parts.emplace_back();
    } else if (quote != 0 || (c != ' ' && c != '\t' && c != '\r')) {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) {
    if (part.find('\\') != part.npos) part = "*";
  }
  return parts;
}

// Names of lists without an item, and names that tables or dotted keys go through.
class EmptyLists {
 public:
  explicit EmptyLists(std::string_view text) {
    std::size_t keyBegin = 0;
    char quote = 0;
    bool isHeader = false, lineIsNew = true;
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (quote != 0) {
        if (c == '\\' && quote == '"') {
          ++i;
        } else if (c == quote || c == '\n') {
          quote = 0;
        }
        continue;
      }
      if (c == '#') {
        while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '=') {
        std::vector<std::string> parts = partsOf(text.substr(keyBegin, i - keyBegin));
        if (isEmptyListAt(text, i + 1)) empty_.insert(parts.back());
        parts.pop_back();
        passed_.insert(parts.begin(), parts.end());
      } else if (c == '[') {
        isHeader = isHeader || (lineIsNew && depth == 0);
        ++depth;
        keyBegin = i + 1;
      } else if (c == ']') {
        if (isHeader && depth > 0) {
          const auto parts = partsOf(text.substr(keyBegin, i - keyBegin));
          passed_.insert(parts.begin(), parts.end());
          isHeader = false;
        }
        depth = std::max(0, depth - 1);
      } else if (c == '{' || c == ',') {
        keyBegin = i + 1;
      } else if (c == '\n') {
        keyBegin = i + 1;
        lineIsNew = true;
        if (isHeader) depth = 0;
        isHeader = false;
        continue;
      }
      if (c != ' ' && c != '\t' && c != '\r' && c != '[') lineIsNew = false;
    }
  }

  /// One that a table or a dotted key goes through.
  std::optional<std::string> entered() const {
    if (empty_.empty() || passed_.empty()) return {};
    if (empty_.count("*") > 0) return *passed_.begin();
    if (passed_.count("*") > 0) return *empty_.begin();
    for (const std::string& name : empty_) {
      if (passed_.count(name) > 0) return name;
    }
    return {};
  }

 private:
  static bool isEmptyListAt(std::string_view text, std::size_t at) {
    const auto skip = [&](const char* blanks) {
      at = std::min(text.find_first_not_of(blanks, at), text.size());
    };
    skip(" \t");
    if (at == text.size() || text[at] != '[') return false;
    for (++at; at < text.size();) {
      skip(" \t\r\n");
      if (at == text.size() || text[at] != '#') break;
      at = std::min(text.find('\n', at), text.size());
    }
    return at == text.size() || text[at] == ']';
  }

  std::set<std::string> empty_, passed_;
};

// The digits of a binary number do not fit a whole number of 64 bits.
bool hasLongBinary(std::string_view code) {
  for (auto at = code.find("0b"); at != code.npos; at = code.find("0b", at + 2)) {
    const auto end = std::min(code.find_first_not_of("01_", at + 2), code.size());
    if (std::count_if(code.begin() + static_cast<std::ptrdiff_t>(at) + 2,
                      code.begin() + static_cast<std::ptrdiff_t>(end),
                      [](char c) { return c != '_'; }) > 62)
      return true;
  }
  return false;
}

}  // namespace

void refuseTomlHazards(std::string_view text, const std::string& file) {
  if (const auto name = EmptyLists(text).entered()) {
    throw FileError(
        fmt::format("{}: '{}' is an empty list, must have no keys of its own", file, *name));
  }
  constexpr int deepest = 100, mostValues = 10000;
  int brackets = 0;
  std::ptrdiff_t values = 0;  // or rather signs that one follows
  for (int number = 1; !text.empty(); ++number) {
    const auto end = std::min(text.find('\n'), text.size());
    if (!isUtf8(text.substr(0, end))) {
      throw FileError(fmt::format("{}:{}: not text, must be UTF-8", file, number));
    }
    const std::optional<std::string> code = codeOf(text.substr(0, end));
    if (!code) {
      throw FileError(
          fmt::format("{}:{}: a text in three quotes, must be in one line", file, number));
    }
    if (hasLongBinary(*code)) {
      throw FileError(
          fmt::format("{}:{}: a binary number, must have at most 62 digits", file, number));
    }
    int dots = 0;
    for (const char c : *code) {
      if (c == '[' || c == '{') ++brackets;
      if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
      dots = c == '.' ? dots + 1 : c == ',' || c == '=' ? 0 : dots;
      if (brackets > deepest || dots > deepest) {
        throw FileError(fmt::format("{}:{}: nested tables or lists, must be at most {} deep", file,
                                    number, deepest));
      }
    }
    values +=
        std::count_if(code->begin(), code->end(), [](char c) { return c == '=' || c == ','; });
    if (values > mostValues) {
      throw FileError(fmt::format("{}:{}: more than {} values, must be at most so many", file,
                                  number, mostValues));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace bio
