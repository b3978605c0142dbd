#include "discover/excess_error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/text.h"

namespace app {
namespace {

using info::discover::ExcessError;

enum class Outcome { noise, expected, none, share };

Outcome outcomeOf(const ExcessError& gap) {
  // the same three deviations of a mean square as explainExcess() has
  if (gap.after * gap.after < 1.2 * gap.floor * gap.floor) return Outcome::noise;
  // a held-out trial that was nearer to the model as it came has gained nothing
  const bool isWorse = gap.expected && gap.after >= gap.nominal;
  if (!gap.closedFromCalibrated || !(*gap.closedFromCalibrated > 0) || isWorse)
    return Outcome::none;
  const bool isExpected =
      gap.expected && gap.after * gap.after < 1.2 * *gap.expected * *gap.expected;
  return isExpected && *gap.closedFromCalibrated > 0.5 ? Outcome::expected : Outcome::share;
}

/// Whole per cent of what is neither all nor nothing.
int percent(const ExcessError& gap) {
  return std::clamp(static_cast<int>(std::lround(100 * *gap.closedFromCalibrated)), 1, 99);
}

}  // namespace

std::string symbolOf(const std::string& unit) {
  if (unit == "deg") return "°";
  if (unit.empty()) return "";
  return unit == "sd" ? " sd of the noise" : " " + unit;
}

std::string excessErrorWords(const ExcessError& gap, double unit, const std::string& symbol,
                             bool heldOut) {
  const auto figure = [&](double value) { return numberText(unit * value, 2) + symbol; };
  const char* where = heldOut ? " on the held-out trial" : "";
  switch (outcomeOf(gap)) {
    case Outcome::noise:
      return fmt::format("The residual{} is at the noise floor ({}).", where, figure(gap.after));
    case Outcome::expected:
      return fmt::format("The residual{} is {} expected ({}, expected {}).", where,
                         gap.after > *gap.expected ? "about as large as" : "no larger than",
                         figure(gap.after), figure(*gap.expected));
    case Outcome::share:
      return fmt::format("{} % of the excess error is explained{}.", percent(gap), where);
    case Outcome::none:
      break;
  }
  const double expected = gap.expected.value_or(gap.floor);
  return heldOut
             ? fmt::format("The fit does not carry over to the held-out trial ({}, expected {}).",
                           figure(gap.after), figure(expected))
             : fmt::format("None of the excess error is explained ({}, noise {}).",
                           figure(gap.after), figure(gap.floor));
}

std::string excessErrorCell(const ExcessError& gap) {
  switch (outcomeOf(gap)) {
    case Outcome::noise:
      return "at the noise floor";
    case Outcome::expected:
      return "as expected";
    case Outcome::share:
      return fmt::format("{} %", percent(gap));
    case Outcome::none:
      break;
  }
  return "none";
}

}  // namespace app
