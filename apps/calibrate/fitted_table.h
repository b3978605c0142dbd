#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "info/discovery/likelihood/fitted_numbers.h"

namespace app {

/// parameters.csv: `name,unit,nominal,estimate,sd,prior_sd,prior_z`, one row per parameter; an
/// empty cell means unknown.
void writeFitted(const std::vector<info::discover::FittedNumber>& numbers, std::ostream& out);

/// These numbers as a list of JSON objects, null where unknown.
nlohmann::ordered_json fittedJson(const std::vector<info::discover::FittedNumber>& numbers);

}  // namespace app
