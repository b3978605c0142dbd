#include "options/named_pairs.h"

#include <fmt/format.h>

#include <stdexcept>

#include "options/quantity.h"

namespace app {
namespace {

NamedPair parsePair(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == text.npos ? 0 : equals);
  if (equals == text.npos || equals == 0 || colon == text.npos) {
    throw std::invalid_argument(fmt::format("'{}' must be NAME=NUMBER:NUMBER", text));
  }
  return {text.substr(0, equals), parseNumber(text.substr(equals + 1, colon - equals - 1)),
          parseNumber(text.substr(colon + 1))};
}

}  // namespace

std::vector<NamedPair> parsePairs(const std::vector<std::string>& texts, const char* option) {
  std::vector<NamedPair> pairs;
  for (const std::string& text : texts) {
    try {
      pairs.push_back(parsePair(text));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: {}", option, error.what()));
    }
    for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
      if (pairs[i].name == pairs.back().name) {
        throw std::invalid_argument(fmt::format("{}: '{}' is given twice", option, pairs[i].name));
      }
    }
  }
  return pairs;
}

}  // namespace app
