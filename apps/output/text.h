#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bio/model/units.h"

/// How the program writes text: one-line messages, numbers for people, escapes for HTML.
namespace app {

/// The text with line breaks turned into "; " and space trimmed from both ends.
std::string oneLine(std::string_view text);

/// The number with at most `digits` significant digits; "–" when it is not finite.
std::string numberText(double value, int digits = 4);

/// The number with all its digits, for a cell of a table; empty when it is not finite.
std::string cellText(double value);
/// The number for a cell, with at most `digits` significant digits.
std::string cellText(double value, int digits);

/// The number that a text written by this program begins with; also one below the least normal
/// number, 2.2e-308.
double numberIn(const std::string& text);

/// "0.016 m", or "0.016" for a pure number.
std::string withUnit(double value, const std::string& unit, int digits = 4);

/// "1 muscle", "3 muscles": a number of things whose plural ends in s.
std::string counted(std::size_t count, const std::string& noun);

/// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& words);

/// "Both parameters are identifiable": how many of all are, without a full stop.
std::string identifiableWords(std::ptrdiff_t identifiable, std::ptrdiff_t all);

/// The word quoted for a shell, if it needs quotes.
std::string shellWord(const std::string& word);

/// & < > " ' replaced by their HTML entities.
std::string htmlText(std::string_view text);

/// A unit as figures and sentences show it: "N m" for "N·m", "1" for none.
std::string unitText(const std::string& unit);

/// Angles are shown in degrees, everything else in its unit.
bio::ShownUnit shownUnit(const std::string& unit);

/// The bytes in base 64, on one line.
std::string base64(const std::string& bytes);

/// The text with each {{name}} replaced by the value of that name, nothing if there is none; what
/// is put in is not searched again.
std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace app
