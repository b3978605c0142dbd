#include "report/svg_text.h"

#include <cstddef>

#include "output/text.h"

namespace app {
namespace {

/// Bytes of the character that begins here; 0: not valid UTF-8, or not allowed in XML.
std::size_t characterLength(std::string_view rest) {
  const auto byte = [&](std::size_t i) {
    return i < rest.size() ? static_cast<unsigned char>(rest[i]) : 0U;
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x20) return first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  if (first < 0x7F) return 1;
  if (first >= 0xC2 && first < 0xE0 && follows(1)) return first == 0xC2 && byte(1) < 0xA0 ? 0 : 2;
  if (first >= 0xE0 && first < 0xF0 && follows(1) && follows(2)) {
    const unsigned code = (first & 0x0FU) << 12U | (byte(1) & 0x3FU) << 6U | (byte(2) & 0x3FU);
    return code < 0x800 || (code >= 0xD800 && code < 0xE000) || code >= 0xFFFE ? 0 : 3;
  }
  const bool isFour = first >= 0xF0 && first < 0xF5 && follows(1) && follows(2) && follows(3);
  return isFour && !(first == 0xF0 && byte(1) < 0x90) && !(first == 0xF4 && byte(1) >= 0x90) ? 4
                                                                                             : 0;
}

}  // namespace

double textWidth(std::string_view text) {
  double width = 0;
  for (const char c : text) {
    if ((c & 0xC0) == 0x80) continue;  // inside a character
    constexpr std::string_view narrow = "ijltfrI.,:;'|![]()/-^ ", wide = "mwMW@%";
    const bool isCapital = c >= 'A' && c <= 'Z';
    width += narrow.find(c) != narrow.npos ? 0.40
             : wide.find(c) != wide.npos   ? 0.98
             : isCapital                   ? 0.72
                                           : 0.63;
  }
  return width;
}

std::string svgText(std::string_view text) {
  return htmlText(xmlCharacters(text));
}

std::string xmlCharacters(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    valid += length == 0 ? std::string_view("\uFFFD") : text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return valid;
}

}  // namespace app
