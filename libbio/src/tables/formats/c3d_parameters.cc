#include "tables/formats/c3d_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "tables/cells.h"
#include "tables/text_file.h"

namespace bio::tables {
namespace {

// Blanks and zero bytes fill texts up.
std::string filledText(std::string_view text) {
  const auto zero = text.find('\0');
  return onOneLine(inUtf8(std::string(trimmed(text.substr(0, zero)))));
}

std::string nameOfEntry(std::string_view text) {
  std::string name = filledText(text);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

// "LABELS", "LABELS2", "LABELS3", …
std::string continued(const std::string& name, int part) {
  return part == 1 ? name : name + std::to_string(part);
}

}  // namespace

C3dParameters::C3dParameters(const Bytes& bytes, std::size_t start) : bytes_(bytes) {
  constexpr std::string_view what = "parameter section";
  std::map<int, std::string> groups;
  std::vector<Entry> entries;
  // The data are behind it. The section tells its length, too, but in some files too little.
  const std::size_t data = bytes_.uint16(16, "header");
  const std::size_t end = data > 0 ? (data - 1) * 512 : bytes_.size();
  for (std::size_t at = start + 4;;) {
    // length of the name, negative if locked; number of the group, negative for the group itself
    const int nameLength = std::abs(static_cast<std::int8_t>(bytes_.uint8(at, what)));
    if (nameLength == 0) break;
    const int group = static_cast<std::int8_t>(bytes_.uint8(at + 1, what));
    const auto length = static_cast<std::size_t>(nameLength);
    const std::string name = nameOfEntry(bytes_.text(at + 2, length, what));
    const std::size_t pointer = at + 2 + length;
    const std::size_t offset = bytes_.uint16(pointer, what);
    std::size_t description = pointer + 2;
    if (group < 0) {
      groups.emplace(-group, name);
    } else if (group > 0) {
      entries.push_back({group, name, valueAt(pointer + 2, name)});
      const Value& value = entries.back().value;
      description = value.at + value.count * static_cast<std::size_t>(std::abs(value.type));
    }
    if (offset == 0) break;
    at = pointer + offset;
    if (offset >= 2 && at < end) continue;
    // the last entry of some files points anywhere; nothing but zeros is behind it
    const std::size_t behind = description + 1 + bytes_.uint8(description, what);
    if (bytes_.uint8(behind, what) == 0) break;
    bytes_.fail(
        fmt::format("parameter '{}': next entry at byte {}, must be behind byte {} and "
                    "before {}",
                    name, at, pointer + 1, end));
  }
  // parameters of no group mean nothing that is known here
  for (const Entry& entry : entries) {
    const auto group = groups.find(entry.group);
    if (group != groups.end()) values_.emplace(group->second + ":" + entry.name, entry.value);
  }
}

C3dParameters::Value C3dParameters::valueAt(std::size_t at, const std::string& name) const {
  const std::string what = fmt::format("parameter '{}'", name);
  Value value;
  value.type = static_cast<std::int8_t>(bytes_.uint8(at, what));
  if (value.type != -1 && value.type != 1 && value.type != 2 && value.type != 4) {
    bytes_.fail(fmt::format("{}: type {}, must be -1 (text), 1, 2 or 4", what, value.type));
  }
  const std::size_t dimensions = bytes_.uint8(at + 1, what);
  if (dimensions > 7) bytes_.fail(fmt::format("{}: {} dimensions, must be ≤ 7", what, dimensions));
  value.count = 1;
  for (std::size_t d = 0; d < dimensions; ++d) {
    value.dimensions.push_back(bytes_.uint8(at + 2 + d, what));
    value.count *= value.dimensions.back();
  }
  value.at = at + 2 + dimensions;
  bytes_.require(value.at, value.count * static_cast<std::size_t>(std::abs(value.type)), what);
  return value;
}

std::vector<double> C3dParameters::numbers(const std::string& name, bool isUnsigned) const {
  const auto found = values_.find(name);
  if (found == values_.end()) return {};
  const Value& value = found->second;
  if (value.type < 0) bytes_.fail(fmt::format("{}: is a text, must be a number", name));
  std::vector<double> out;
  out.reserve(value.count);
  for (std::size_t i = 0; i < value.count; ++i) {
    const std::size_t at = value.at + i * static_cast<std::size_t>(value.type);
    if (value.type == 4) {
      out.push_back(static_cast<double>(bytes_.float32Within(at)));
    } else if (value.type == 2) {
      const std::uint16_t bits = bytes_.uint16Within(at);
      out.push_back(isUnsigned ? bits : static_cast<std::int16_t>(bits));
    } else {
      const auto bits = static_cast<std::uint8_t>(bytes_.uintWithin(at, 1));
      out.push_back(isUnsigned ? bits : static_cast<std::int8_t>(bits));
    }
  }
  return out;
}

std::vector<double> C3dParameters::allNumbers(const std::string& name, bool isUnsigned) const {
  std::vector<double> out;
  for (int part = 1; has(continued(name, part)); ++part) {
    const std::vector<double> more = numbers(continued(name, part), isUnsigned);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

std::vector<std::string> C3dParameters::texts(const std::string& name) const {
  std::vector<std::string> out;
  for (int part = 1; has(continued(name, part)); ++part) {
    const Value& value = values_.at(continued(name, part));
    if (value.type != -1) {
      bytes_.fail(fmt::format("{}: is a number, must be a text", continued(name, part)));
    }
    if (value.count == 0) continue;
    const std::size_t length = value.dimensions.empty() ? 1 : value.dimensions.front();
    for (std::size_t at = 0; at < value.count; at += length) {
      out.push_back(filledText(bytes_.text(value.at + at, length, name)));
    }
  }
  return out;
}

}  // namespace bio::tables
