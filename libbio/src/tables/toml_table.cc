#include "tables/toml_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "bio/tables/file_error.h"
#include "tables/text_file.h"
#include "tables/toml_hazards.h"

namespace bio {
namespace {

// The first line of toml11's picture of an error, without its own prefix.
std::string firstLine(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  const auto prefix = line.find(": ");
  if (line.starts_with("[error]") && prefix != std::string::npos) line = line.substr(prefix + 2);
  return line;
}

// Without a width: toml11 never comes to the end of some texts beside a long key.
std::string shown(const toml::value& value) {
  std::string text = toml::format(value, std::numeric_limits<std::size_t>::max());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.find('\n') == std::string::npos ? text : "…";
}

bool isNumber(const toml::value& value) {
  return value.is_floating() || value.is_integer();
}

double asNumber(const toml::value& value) {
  return value.is_integer() ? static_cast<double>(value.as_integer()) : value.as_floating();
}

// 1e400 is read as the largest number there is.
bool isTooLarge(const toml::value& value) {
  return std::abs(asNumber(value)) == std::numeric_limits<double>::max();
}

int lineOf(const toml::value& value) {
  return static_cast<int>(value.location().line());
}

}  // namespace

TomlTable::TomlTable(std::string file, std::string name, toml::value value)
    : file_(std::move(file)), name_(std::move(name)), value_(std::move(value)) {}

TomlTable TomlTable::read(const std::string& file) {
  const std::string text = readTextFile(file);
  refuseTomlHazards(text, file);
  std::istringstream stream(text);
  try {
    return {file, "", toml::parse(stream, file)};
  } catch (const toml::exception& e) {
    throw FileError(
        fmt::format("{}:{}: no valid TOML: {}", file, e.location().line(), firstLine(e.what())));
  }
}

int TomlTable::line() const {
  return lineOf(value_);
}

bool TomlTable::has(const std::string& key) const {
  return value_.contains(key);
}

const toml::value* TomlTable::find(const std::string& key) {
  known_.insert(key);
  return value_.contains(key) ? &value_.at(key) : nullptr;
}

void TomlTable::fail(const std::string& key, const std::string& rule) const {
  const toml::value& value = value_.at(key);
  throw FileError(
      fmt::format("{}:{}: {}{} = {}, {}", file_, lineOf(value), name_, key, shown(value), rule));
}

void TomlTable::missing(const std::string& key) const {
  throw FileError(fmt::format("{}:{}: {}needs a key '{}'", file_, line(), name_, key));
}

std::optional<double> TomlTable::number(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!isNumber(*value)) fail(key, "must be a number");
  if (isTooLarge(*value)) fail(key, "is too large a number");
  return asNumber(*value);
}

std::optional<int> TomlTable::integer(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_integer() || value->as_integer() > 1'000'000 || value->as_integer() < -1'000'000) {
    fail(key, "must be a whole number");
  }
  return static_cast<int>(value->as_integer());
}

std::optional<bool> TomlTable::flag(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_boolean()) fail(key, "must be true or false");
  return value->as_boolean();
}

std::optional<std::string> TomlTable::text(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_string()) fail(key, "must be a text in quotes");
  return value->as_string().str;
}

std::optional<std::vector<double>> TomlTable::numbers(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_array()) fail(key, "must be a list of numbers");
  std::vector<double> out;
  for (const toml::value& item : value->as_array()) {
    if (!isNumber(item)) fail(key, "must be a list of numbers");
    if (isTooLarge(item)) fail(key, "holds too large a number");
    out.push_back(asNumber(item));
  }
  return out;
}

std::vector<std::string> TomlTable::texts(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return {};
  if (value->is_string()) return {value->as_string().str};
  const char* rule = "must be a text in quotes or a list of them";
  if (!value->is_array()) fail(key, rule);
  std::vector<std::string> out;
  for (const toml::value& item : value->as_array()) {
    if (!item.is_string()) fail(key, rule);
    out.push_back(item.as_string().str);
  }
  return out;
}

std::optional<std::string> TomlTable::word(const std::string& key,
                                           const std::vector<std::string>& words) {
  std::optional<std::string> value = text(key);
  if (value && std::find(words.begin(), words.end(), *value) == words.end()) {
    fail(key, fmt::format("must be one of {}", fmt::join(words, ", ")));
  }
  return value;
}

std::vector<std::pair<std::string, double>> TomlTable::weights(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) missing(key);
  std::vector<std::pair<std::string, double>> out;
  if (value->is_array()) {
    for (const toml::value& item : value->as_array()) {
      if (!item.is_string()) fail(key, "must be a list of muscle names");
      out.emplace_back(item.as_string().str, 1.0);
    }
    return out;
  }
  if (!value->is_table()) fail(key, "must be { muscle = weight, … } or a list of muscle names");
  // toml11 forgets the order, their places in the file do not
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, std::string>> places;
  for (const auto& [name, weight] : value->as_table()) {
    if (!isNumber(weight)) fail(key, fmt::format("weight of '{}' must be a number", name));
    const auto place = weight.location();
    places.push_back({{place.line(), place.column()}, name});
  }
  std::sort(places.begin(), places.end());
  for (const auto& [place, name] : places) out.emplace_back(name, asNumber(value->at(name)));
  return out;
}

std::vector<std::pair<std::string, std::string>> TomlTable::names(const std::string& key) {
  const toml::value* value = find(key);
  if (value == nullptr) return {};
  const char* rule = "must be { name = \"name\", … }";
  if (!value->is_table()) fail(key, rule);
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& [name, other] : value->as_table()) {
    if (!other.is_string()) fail(key, rule);
    out.emplace_back(name, other.as_string().str);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::value* value = find(key);
  const std::string name = fmt::format("[{}] ", key);
  if (value == nullptr) return {file_, name, toml::value(toml::table{})};
  if (!value->is_table()) fail(key, fmt::format("must be a table, [{}]", key));
  return {file_, name, *value};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  const toml::value* value = find(key);
  std::vector<TomlTable> out;
  if (value == nullptr) return out;
  const std::string rule = fmt::format("must be a list of tables, [[{}]]", key);
  if (!value->is_array()) fail(key, rule);
  for (const toml::value& item : value->as_array()) {
    if (!item.is_table()) fail(key, rule);
    out.push_back({file_, fmt::format("[[{}]] ", key), item});
  }
  return out;
}

void TomlTable::finish() const {
  std::optional<std::pair<int, std::string>> first;
  for (const auto& [key, value] : value_.as_table()) {
    if (known_.contains(key)) continue;
    if (!first || lineOf(value) < first->first) first = {lineOf(value), key};
  }
  if (first) {
    throw FileError(fmt::format("{}:{}: {}unknown key '{}', there are {}", file_, first->first,
                                name_, first->second, fmt::join(known_, ", ")));
  }
}

}  // namespace bio
