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
  for (const info::discover::FittedNumber& one : numbers) {
    out << fmt::format("{},{},{},{},{},{},{}\n", one.name, one.unit, numberOrEmpty(one.nominal),
                       numberOrEmpty(one.estimate), numberOrEmpty(one.sd), numberOrEmpty(one.prior),
                       numberOrEmpty(one.priorZ));
  }
}

nlohmann::ordered_json fittedJson(const std::vector<info::discover::FittedNumber>& numbers) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const info::discover::FittedNumber& one : numbers) {
    list.push_back({{"name", one.name},
                    {"unit", one.unit},
                    {"nominal", orNull(one.nominal)},
                    {"estimate", orNull(one.estimate)},
                    {"sd", orNull(one.sd)},
                    {"prior_sd", orNull(one.prior)},
                    {"prior_z", orNull(one.priorZ)}});
  }
  return list;
}

}  // namespace app
