#include "info/information/parameter.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace info {

std::string label(const Parameter& parameter) {
  return parameter.unit.empty() ? parameter.name
                                : fmt::format("{} [{}]", parameter.name, parameter.unit);
}

void checkParameters(const std::vector<Parameter>& parameters) {
  std::set<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (parameter.name.empty())
      throw std::invalid_argument("a parameter has no name, must have one");
    if (!names.insert(parameter.name).second)
      throw std::invalid_argument(
          fmt::format("parameter {} is listed twice, must be listed once", parameter.name));
    if (!std::isfinite(parameter.start))
      throw std::invalid_argument(
          fmt::format("parameter {}: start {} must be finite", label(parameter), parameter.start));
    if (!(parameter.lower <= parameter.upper))
      throw std::invalid_argument(
          fmt::format("parameter {}: lower bound {} must be ≤ upper bound {}", label(parameter),
                      parameter.lower, parameter.upper));
    if (!(parameter.lower <= parameter.start && parameter.start <= parameter.upper))
      throw std::invalid_argument(
          fmt::format("parameter {}: start {} must be within its bounds {} … {}", label(parameter),
                      parameter.start, parameter.lower, parameter.upper));
    if (!parameter.prior) continue;
    if (!(parameter.prior->sd > 0 && std::isfinite(parameter.prior->sd)))
      throw std::invalid_argument(
          fmt::format("parameter {}: prior standard deviation {} must be > 0 and finite",
                      label(parameter), parameter.prior->sd));
    if (!std::isfinite(parameter.prior->mean))
      throw std::invalid_argument(fmt::format("parameter {}: prior mean {} must be finite",
                                              label(parameter), parameter.prior->mean));
  }
}

}  // namespace info
