#pragma once

#include <string>
#include <vector>

namespace app {

/// NAME=A:B, as --prior and --bounds take it.
struct NamedPair {
  std::string name;  ///< as typed
  double first, second;
};

/// @param option  its name, for the message
/// @throws std::invalid_argument if one is not NAME=NUMBER:NUMBER, or a name is given twice
std::vector<NamedPair> parsePairs(const std::vector<std::string>& texts, const char* option);

}  // namespace app
