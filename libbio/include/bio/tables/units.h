#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bio {

/// A unit that an instrument writes beside its numbers: value in `si` = factor·value.
struct KnownUnit {
  std::string_view name;  ///< our spelling: "uV", "deg", "N mm"
  std::string_view si;    ///< "V", "rad", "rad/s", "N m", "N", "m", "m/s", "m/s²", "s", "Hz", "kg", "1"
  double factor;
};

/// The unit of a spelling. Blanks, dots, hyphens and · between parts, the case of words and plurals
/// do not matter, nor whether µ and ° are written in UTF-8, Latin-1 or as words: "µV", "microvolts",
/// "N·m", "Nm", "FT-LBS", "DEG/SEC", "°/s", "inches". "g" and "G" are standard gravity, as on
/// accelerometers; "lb" and "kg" as units of force are not taken for one. Factors: NIST Special
/// Publication 811 (2008), appendix B.
/// Nothing for a spelling that is not known, and for an empty one.
std::optional<KnownUnit> knownUnit(std::string_view spelled);

/// Whether two spellings mean the same unit; of unknown ones, whether they are equal.
bool areSameUnit(std::string_view a, std::string_view b);

}  // namespace bio
