#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace app {

/// JSON as text. What is not UTF-8, in a stranger's file or name of a file, becomes U+FFFD.
/// @param indent  spaces per level; negative: all on one line
inline std::string jsonText(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace app
