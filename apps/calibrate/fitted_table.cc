#include "calibrate/fitted_table.h"

#include <fmt/format.h>

#include <cmath>

#include "output/json_text.h"

namespace app {
namespace {

std::string numberOrEmpty(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

}  // namespace

void writeFitted(const std::vector<info::discover::FittedNumber>& numbers, std::ostream& out) {
  out << "name,unit,nominal,estimate,sd,prior_sd,prior_z\n";
  for (const info::discover::FittedNumber& number : numbers) {
    out << fmt::format("{},{},{},{},{},{},{}\n", number.name, number.unit,
                       numberOrEmpty(number.nominal), numberOrEmpty(number.estimate),
                       numberOrEmpty(number.sd), numberOrEmpty(number.prior),
                       numberOrEmpty(number.priorZ));
  }
}

nlohmann::ordered_json fittedJson(const std::vector<info::discover::FittedNumber>& numbers) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const info::discover::FittedNumber& number : numbers) {
    list.push_back({{"name", number.name},
                    {"unit", number.unit},
                    {"nominal", orNull(number.nominal)},
                    {"estimate", orNull(number.estimate)},
                    {"sd", orNull(number.sd)},
                    {"prior_sd", orNull(number.prior)},
                    {"prior_z", orNull(number.priorZ)}});
  }
  return list;
}

}  // namespace app
