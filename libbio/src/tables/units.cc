#include "bio/tables/units.h"

#include <array>
#include <cctype>

#include "bio/model/units.h"
#include "tables/cells.h"
#include "tables/length_unit.h"

namespace bio {
namespace {

constexpr double inch = 0.0254, foot = 0.3048, poundForce = 4.4482216152605;

struct UnitSpelling {
  std::string_view plain;  ///< as plainSpelling() makes it
  KnownUnit unit;
};

constexpr KnownUnit volt{"V", "V", 1}, millivolt{"mV", "V", 1e-3}, microvolt{"uV", "V", 1e-6},
    nanovolt{"nV", "V", 1e-9}, deg{"deg", "rad", radiansPerDegree}, rad{"rad", "rad", 1},
    degPerSecond{"deg/s", "rad/s", radiansPerDegree}, radPerSecond{"rad/s", "rad/s", 1},
    newtonMetre{"N m", "N m", 1}, newtonMillimetre{"N mm", "N m", 1e-3},
    newtonCentimetre{"N cm", "N m", 1e-2}, footPound{"ft lbf", "N m", foot*poundForce},
    inchPound{"in lbf", "N m", inch*poundForce}, newton{"N", "N", 1}, pound{"lbf", "N", poundForce},
    metre{"m", "m", 1}, centimetre{"cm", "m", 1e-2}, millimetre{"mm", "m", 1e-3},
    inches{"in", "m", inch}, feet{"ft", "m", foot}, metrePerSecond{"m/s", "m/s", 1},
    metrePerSecond2{"m/s²", "m/s²", 1}, gravity{"g", "m/s²", 9.80665}, second{"s", "s", 1},
    millisecond{"ms", "s", 1e-3}, microsecond{"us", "s", 1e-6}, minute{"min", "s", 60},
    hertz{"Hz", "Hz", 1}, kilogram{"kg", "kg", 1}, percent{"%", "1", 1e-2};

constexpr std::array spellings{UnitSpelling{"v", volt},
                               UnitSpelling{"volt", volt},
                               UnitSpelling{"mv", millivolt},
                               UnitSpelling{"millivolt", millivolt},
                               UnitSpelling{"uv", microvolt},
                               UnitSpelling{"microvolt", microvolt},
                               UnitSpelling{"mvolt", millivolt},
                               UnitSpelling{"uvolt", microvolt},
                               UnitSpelling{"microv", microvolt},
                               UnitSpelling{"nv", nanovolt},
                               UnitSpelling{"nanovolt", nanovolt},

                               UnitSpelling{"deg", deg},
                               UnitSpelling{"degree", deg},
                               UnitSpelling{"rad", rad},
                               UnitSpelling{"radian", rad},
                               UnitSpelling{"mrad", {"mrad", "rad", 1e-3}},
                               UnitSpelling{"deg/s", degPerSecond},
                               UnitSpelling{"degree/s", degPerSecond},
                               UnitSpelling{"dps", degPerSecond},
                               UnitSpelling{"rad/s", radPerSecond},
                               UnitSpelling{"radian/s", radPerSecond},
                               UnitSpelling{"mrad/s", {"mrad/s", "rad/s", 1e-3}},
                               UnitSpelling{"rpm", {"rpm", "rad/s", 6 * radiansPerDegree}},

                               UnitSpelling{"nm", newtonMetre},
                               UnitSpelling{"newtonmeter", newtonMetre},
                               UnitSpelling{"newtonmetre", newtonMetre},
                               UnitSpelling{"nmm", newtonMillimetre},
                               UnitSpelling{"newtonmillimeter", newtonMillimetre},
                               UnitSpelling{"newtonmillimetre", newtonMillimetre},
                               UnitSpelling{"ncm", newtonCentimetre},
                               UnitSpelling{"knm", {"kN m", "N m", 1e3}},
                               UnitSpelling{"ftlb", footPound},
                               UnitSpelling{"mnm", {"mN m", "N m", 1e-3}},
                               UnitSpelling{"lbsft", footPound},
                               UnitSpelling{"lbsin", inchPound},
                               UnitSpelling{"ftlbf", footPound},
                               UnitSpelling{"lbft", footPound},
                               UnitSpelling{"lbfft", footPound},
                               UnitSpelling{"footpound", footPound},
                               UnitSpelling{"poundfoot", footPound},
                               UnitSpelling{"inlb", inchPound},
                               UnitSpelling{"inlbf", inchPound},
                               UnitSpelling{"lbin", inchPound},
                               UnitSpelling{"lbfin", inchPound},
                               UnitSpelling{"inchpound", inchPound},

                               UnitSpelling{"n", newton},
                               UnitSpelling{"newton", newton},
                               UnitSpelling{"kn", {"kN", "N", 1e3}},
                               UnitSpelling{"lbf", pound},
                               UnitSpelling{"kgf", {"kgf", "N", 9.80665}},
                               UnitSpelling{"kp", {"kgf", "N", 9.80665}},

                               UnitSpelling{"m", metre},
                               UnitSpelling{"meter", metre},
                               UnitSpelling{"metre", metre},
                               UnitSpelling{"cm", centimetre},
                               UnitSpelling{"centimeter", centimetre},
                               UnitSpelling{"centimetre", centimetre},
                               UnitSpelling{"mm", millimetre},
                               UnitSpelling{"millimeter", millimetre},
                               UnitSpelling{"millimetre", millimetre},
                               UnitSpelling{"um", {"um", "m", 1e-6}},
                               UnitSpelling{"in", inches},
                               UnitSpelling{"inch", inches},
                               UnitSpelling{"inche", inches},
                               UnitSpelling{"ft", feet},
                               UnitSpelling{"foot", feet},
                               UnitSpelling{"feet", feet},

                               UnitSpelling{"m/s", metrePerSecond},
                               UnitSpelling{"cm/s", {"cm/s", "m/s", 1e-2}},
                               UnitSpelling{"mm/s", {"mm/s", "m/s", 1e-3}},
                               UnitSpelling{"m/s2", metrePerSecond2},
                               UnitSpelling{"m/s/s", metrePerSecond2},
                               UnitSpelling{"mm/s2", {"mm/s²", "m/s²", 1e-3}},
                               UnitSpelling{"g", gravity},
                               UnitSpelling{"mg", {"mg", "m/s²", 9.80665e-3}},

                               UnitSpelling{"s", second},
                               UnitSpelling{"ms", millisecond},
                               UnitSpelling{"millisecond", millisecond},
                               UnitSpelling{"us", microsecond},
                               UnitSpelling{"microsecond", microsecond},
                               UnitSpelling{"min", minute},
                               UnitSpelling{"minute", minute},
                               UnitSpelling{"hz", hertz},
                               UnitSpelling{"khz", {"kHz", "Hz", 1e3}},
                               UnitSpelling{"kg", kilogram},
                               UnitSpelling{"kilogram", kilogram},
                               UnitSpelling{"%", percent},
                               UnitSpelling{"percent", percent},
                               UnitSpelling{"pct", percent}};

/// µ, ° and ² in UTF-8 and Latin-1, and what they become.
struct Sign {
  std::string_view bytes, plain;
};
constexpr std::array signs{
    Sign{"\xC2\xB5", "u"},    Sign{"\xCE\xBC", "u"},    Sign{"\xC2\xB0", "deg"},
    Sign{"\xC2\xBA", "deg"},  Sign{"\xC2\xB2", "2"},    Sign{"\xC2\xB7", ""},
    Sign{"\xE2\x8B\x85", ""}, Sign{"\xE2\x88\x99", ""}, Sign{"\xB5", "u"},
    Sign{"\xB0", "deg"},      Sign{"\xBA", "deg"},      Sign{"\xB2", "2"},
    Sign{"\xB7", ""}};

void replaceWord(std::string& text, std::string_view word, std::string_view with) {
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + with.size()))
    text.replace(at, word.size(), with);
}

/// Without what does not distinguish units.
std::string plainSpelling(std::string_view spelled) {
  std::string plain;
  while (!spelled.empty()) {
    bool isSign = false;
    for (const Sign& sign : signs) {
      if (!spelled.starts_with(sign.bytes)) continue;
      plain += sign.plain;
      spelled.remove_prefix(sign.bytes.size());
      isSign = true;
      break;
    }
    if (isSign) continue;
    const char c = spelled.front();
    spelled.remove_prefix(1);
    if (c != ' ' && c != '.' && c != '-' && c != '*' && c != '^' && c != '_' && c != '\t')
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  replaceWord(plain, "persecond", "/s");
  replaceWord(plain, "/seconds", "/s");
  replaceWord(plain, "/second", "/s");
  replaceWord(plain, "/sec", "/s");
  if (plain == "sec" || plain == "secs" || plain == "second" || plain == "seconds") return "s";
  replaceWord(plain, "msec", "ms");
  // plurals: "volts", "degs/s", "ftlbs"
  const auto slash = plain.find('/');
  const auto last = (slash == plain.npos ? plain.size() : slash) - 1;
  if (last >= 3 && last < plain.size() && plain[last] == 's') plain.erase(last, 1);
  return plain;
}

}  // namespace

std::optional<KnownUnit> knownUnit(std::string_view spelled) {
  // the case of a letter tells milli from mega
  if (spelled == "MV") return KnownUnit{"MV", "V", 1e6};
  if (spelled == "MN" || spelled == "mN")
    return spelled == "MN" ? KnownUnit{"MN", "N", 1e6} : KnownUnit{"mN", "N", 1e-3};
  const std::string plain = plainSpelling(spelled);
  for (const UnitSpelling& each : spellings)
    if (each.plain == plain) return each.unit;
  return {};
}

double tables::metresPer(std::string_view unit) {
  if (const auto known = knownUnit(unit)) return known->si == "m" ? known->factor : 0;
  // some programs keep the first letters only
  const std::string low = lowered(trimmed(unit));
  for (const std::string_view whole :
       {"millimeters", "millimetres", "centimeters", "centimetres", "meters", "metres"}) {
    if (low.size() > 2 && whole.starts_with(low)) return knownUnit(whole)->factor;
  }
  return 0;
}

bool areSameUnit(std::string_view a, std::string_view b) {
  const auto one = knownUnit(a), other = knownUnit(b);
  return one && other ? one->name == other->name : a == b;
}

}  // namespace bio
