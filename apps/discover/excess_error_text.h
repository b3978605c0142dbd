#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "info/discovery/judgement/excess_error.h"

namespace app {

/// How much of the excess error (mean square above that of the noise) is explained, in a sentence:
/// "The residual is at the noise floor (0.49°).", "87 % of the excess error is explained.", "The
/// fit does not carry over to the held-out trial (3.2°, expected 0.6°)."
/// @param unit factor from internal to shown values
/// @param symbol symbol after a value, "°" or " N"
std::string excessErrorWords(const info::discover::ExcessError& excess, double unit,
                             const std::string& symbol, bool heldOut);

/// The excess error as a cell of a table: "at the noise floor", "87 %", "none".
std::string excessErrorCell(const info::discover::ExcessError& excess);

/// "°" for deg, " sd of the noise" for sd, else the unit after a space.
std::string symbolOf(const std::string& unit);

/// These errors as an object of verdict.json.
/// @param unit factor from internal to shown values
/// @param end  of the keys, "_deg"
nlohmann::ordered_json excessErrorJson(const info::discover::ExcessError& excess, double unit,
                                       const std::string& end);

}  // namespace app
