#include "discover/excess_error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/json_text.h"
#include "output/text.h"

namespace app {
namespace {

using info::discover::ExcessError;

enum class Outcome { noise, expected, none, share };

Outcome outcomeOf(const ExcessError& excess) {
  // the same three deviations of a mean square as explainExcess() has
  if (excess.after * excess.after < 1.2 * excess.floor * excess.floor) return Outcome::noise;
  // a held-out trial that was nearer to the model as it came has gained nothing
  const bool isWorse = excess.expected && excess.after >= excess.nominal;
  if (!excess.closedFromCalibrated || !(*excess.closedFromCalibrated > 0) || isWorse)
    return Outcome::none;
  const bool isExpected =
      excess.expected && excess.after * excess.after < 1.2 * *excess.expected * *excess.expected;
  return isExpected && *excess.closedFromCalibrated > 0.5 ? Outcome::expected : Outcome::share;
}

/// Whole per cent of what is neither all nor nothing.
int percent(const ExcessError& excess) {
  return std::clamp(static_cast<int>(std::lround(100 * *excess.closedFromCalibrated)), 1, 99);
}

}  // namespace

std::string symbolOf(const std::string& unit) {
  if (unit == "deg") return "°";
  if (unit.empty()) return "";
  return unit == "sd" ? " sd of the noise" : " " + unit;
}

std::string excessErrorWords(const ExcessError& excess, double unit, const std::string& symbol,
                             bool heldOut) {
  const auto figure = [&](double value) { return numberText(unit * value, 2) + symbol; };
  const char* where = heldOut ? " on the held-out trial" : "";
  switch (outcomeOf(excess)) {
    case Outcome::noise:
      return fmt::format("The residual{} is at the noise floor ({}).", where, figure(excess.after));
    case Outcome::expected:
      return fmt::format("The residual{} is {} expected ({}, expected {}).", where,
                         excess.after > *excess.expected ? "about as large as" : "no larger than",
                         figure(excess.after), figure(*excess.expected));
    case Outcome::share:
      return fmt::format("{} % of the excess error is explained{}.", percent(excess), where);
    case Outcome::none:
      break;
  }
  const double expected = excess.expected.value_or(excess.floor);
  return heldOut
             ? fmt::format("The fit does not carry over to the held-out trial ({}, expected {}).",
                           figure(excess.after), figure(expected))
             : fmt::format("None of the excess error is explained ({}, noise {}).",
                           figure(excess.after), figure(excess.floor));
}

std::string excessErrorCell(const ExcessError& excess) {
  switch (outcomeOf(excess)) {
    case Outcome::noise:
      return "at the noise floor";
    case Outcome::expected:
      return "as expected";
    case Outcome::share:
      return fmt::format("{} %", percent(excess));
    case Outcome::none:
      break;
  }
  return "none";
}

nlohmann::ordered_json excessErrorJson(const ExcessError& excess, double unit,
                                       const std::string& end) {
  nlohmann::ordered_json json;
  json["rmse_nominal" + end] = orNull(unit * excess.nominal);
  json["rmse_calibrated" + end] = orNull(unit * excess.calibrated);
  json["rmse_after" + end] = orNull(unit * excess.after);
  if (excess.expected) json["rmse_expected" + end] = orNull(unit * *excess.expected);
  if (excess.probability) json["rmse_probability"] = orNull(*excess.probability);
  json["noise_floor" + end] = orNull(unit * excess.floor);
  json["gap_closed"] = excess.closedFromCalibrated ? orNull(*excess.closedFromCalibrated)
                                                   : nlohmann::ordered_json(nullptr);
  json["gap_closed_from_nominal"] = excess.closedFromNominal ? orNull(*excess.closedFromNominal)
                                                             : nlohmann::ordered_json(nullptr);
  return json;
}

}  // namespace app
