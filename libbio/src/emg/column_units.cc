#include "emg/column_units.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "bio/model/units.h"
#include "bio/tables/units.h"

namespace bio {
namespace {

/// The units in which a column of that name is read; empty: no quantity is known for it.
std::vector<std::string_view> unitsOfColumn(std::string_view name) {
  const auto ends = [&](std::string_view ending) { return name.ends_with(ending); };
  if (ends(".moment") || ends(".torque")) return {"N m", "N"};
  if (ends(".force") || ends(".tendon_force")) return {"N"};
  if (ends(".speed_deg")) return {"rad/s"};
  if (ends(".speed")) return {"rad/s", "m/s"};
  if (ends(".fiber_length") || ends(".x") || ends(".y") || ends(".z")) return {"m"};
  if (ends(".activation")) return {"1"};
  if (ends(".pennation")) return {"rad"};
  if (ends("_deg")) return {"rad"};
  if (name.find('.') == name.npos) return {"rad", "m", "1"};
  return {};
}

/// As the file writes it.
const std::string& writtenUnitOf(const Channel& channel) {
  return channel.writtenUnit.empty() ? channel.unit : channel.writtenUnit;
}

double factorOf(const KnownUnit& unit, const MeasuredOptions& column) {
  return unit.factor * (column.coordinate.ends_with("_deg") ? degreesPerRadian : 1.0);
}

}  // namespace

std::string scaledUnit(const Channel& channel, const MeasuredOptions& column) {
  const std::vector<std::string_view> expected = unitsOfColumn(column.coordinate);
  const auto unit = knownUnit(channel.unit);
  if (!unit || std::find(expected.begin(), expected.end(), unit->si) == expected.end()) return "";
  const double factor = factorOf(*unit, column), scale = column.degreesPerUnit;
  if (std::abs(factor - 1) < 1e-12 || std::abs(scale / factor - 1) < 1e-3) return "";
  return fmt::format(
      "{}: channel '{}' is in {}; its numbers were not converted to {}, but taken times the scale "
      "{:g} of the configuration.",
      column.coordinate, channel.name, channel.unit,
      column.coordinate.ends_with("_deg") ? "deg" : unit->si, scale * column.sign);
}

std::string setUnit(const Channel& channel, MeasuredOptions& column) {
  const std::vector<std::string_view> expected = unitsOfColumn(column.coordinate);
  if (expected.empty()) return "";
  const bool inDegrees = column.coordinate.ends_with("_deg");
  const std::string shown = inDegrees ? "deg" : fmt::format("{}", fmt::join(expected, " or "));
  if (channel.unit.empty()) {
    return fmt::format("{}: channel '{}' states no unit; its numbers were taken to be in {}.",
                       column.coordinate, channel.name, shown);
  }
  const auto unit = knownUnit(channel.unit);
  if (!unit) {
    throw std::invalid_argument(
        fmt::format("'{}' must be in {}, but channel '{}' is in '{}', a unit that is not known "
                    "(give scale, the "
                    "factor to {})",
                    column.coordinate, shown, channel.name, writtenUnitOf(channel), shown));
  }
  if (std::find(expected.begin(), expected.end(), unit->si) == expected.end()) {
    throw std::invalid_argument(fmt::format(
        "'{}' must be in {}, but channel '{}' is in '{}' (give scale, the factor to {})",
        column.coordinate, shown, channel.name, writtenUnitOf(channel), shown));
  }
  column.degreesPerUnit = factorOf(*unit, column);
  if (std::abs(column.degreesPerUnit - 1) < 1e-12) {
    column.degreesPerUnit = 1;
    return "";
  }
  return fmt::format("{}: channel '{}' was converted from {} to {}.", column.coordinate,
                     channel.name, writtenUnitOf(channel),
                     inDegrees ? "deg" : std::string(unit->si));
}

}  // namespace bio
