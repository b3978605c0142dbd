#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace app {

/// JSON as text. Bytes that are not UTF-8, e.g. of a file name, become U+FFFD.
/// @param indent  spaces per level; negative: all on one line
inline std::string jsonText(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// JSON for a script element, which it must not be able to end.
inline std::string scriptText(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : jsonText(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

/// The number; null where it is infinite or NaN, for which JSON has no word.
inline nlohmann::ordered_json orNull(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// For a cell of a table; empty for what is not a number.
inline std::string numberCell(const nlohmann::ordered_json& value) {
  return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : std::string();
}

}  // namespace app
