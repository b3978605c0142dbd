#include "bio/muscle/muscle_property.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio::muscles {
namespace {

std::string describe(const Range& range) {
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  std::string text;
  if (below) text = fmt::format("{} {}", range.withLow ? ">=" : ">", range.low);
  if (above) {
    text += fmt::format("{}{} {}", below ? " and " : "", range.withHigh ? "<=" : "<", range.high);
  }
  return text.empty() ? "finite" : text;
}

}  // namespace

void requireWithin(const MuscleProperty& property, double value) {
  if (property.range.holds(value) && std::isfinite(value)) return;
  throw std::invalid_argument(fmt::format("{} is {}{}{}, must be {}", property.name, value,
                                          property.unit.empty() ? "" : " ", property.unit,
                                          describe(property.range)));
}

void requireRule(bool holds, std::string_view name, double value, std::string_view rule) {
  if (!holds) {
    throw std::invalid_argument(fmt::format("{} is {}, must be {}", name, value, rule));
  }
}

}  // namespace bio::muscles
