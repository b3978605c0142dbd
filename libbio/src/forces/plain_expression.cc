#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bio/forces/coordinate_force.h"

namespace bio {

std::string plainExpression(const ExpressionBasedCoordinateForce& law) {
  std::string plain;
  const std::string& text = law.expression;
  for (std::size_t i = 0; i < text.size();) {
    const auto isWord = [&](std::size_t at) {
      return std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_' ||
             text[at] == '.';
    };
    std::size_t end = i;
    while (end < text.size() && isWord(end)) ++end;
    if (end == i) {
      plain += text[i++];
      continue;
    }
    const std::string word = text.substr(i, end - i);
    const auto at = std::find_if(law.constants.begin(), law.constants.end(),
                                 [&](const NamedConstant& c) { return c.name == word; });
    if (at == law.constants.end()) {
      plain += word;
    } else if (!std::isfinite(at->value)) {
      throw std::invalid_argument(fmt::format("expression of '{}': {} = {}, must be finite",
                                              law.name, at->name, at->value));
    } else {
      plain +=
          at->value < 0 ? fmt::format("({:.17g})", at->value) : fmt::format("{:.17g}", at->value);
    }
    i = end;
  }
  return plain;
}

}  // namespace bio
