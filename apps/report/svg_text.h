#pragma once

#include <string>
#include <string_view>

namespace app {

/// About how wide a text is drawn, in units of the font's size. Rather too wide than too narrow: of
/// DejaVu Sans, the widest of the fonts that drawings name.
double textWidth(std::string_view text);

/// The text for an XML file, escaped.
std::string svgText(std::string_view text);

/// What of a text an XML file can hold: valid UTF-8 without control characters; U+FFFD in place of
/// the rest.
std::string xmlCharacters(std::string_view text);

}  // namespace app
