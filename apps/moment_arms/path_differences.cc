#include "moment_arms/path_differences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "output/angle_unit.h"
#include "output/text.h"

namespace app {
namespace {

/// [deg] or [mm]
double shownValue(double value, bool turns) {
  return turns ? value / degree : 1000 * value;
}

std::string unitOf(bool turns) {
  return turns ? "deg" : "mm";
}

std::string inMillimetres(double length) {
  return numberText(1000 * length, 3);
}

}  // namespace

nlohmann::ordered_json jumpsAsJson(const std::vector<bio::LengthJump>& jumps) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const bio::LengthJump& jump : jumps) {
    all.push_back({{"muscle", jump.muscle},
                   {"coordinate", jump.coordinate},
                   {"at_" + unitOf(jump.turns), shownValue(jump.value, jump.turns)},
                   {"length_mm", 1000 * jump.size},
                   {"moment_arm_mm", 1000 * jump.arm},
                   {"conditional_point", jump.conditional}});
  }
  return all;
}

nlohmann::ordered_json departuresAsJson(const std::vector<bio::OpenSimDeparture>& departures) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const bio::OpenSimDeparture& d : departures) {
    const std::string at = "at_" + unitOf(d.turns);
    all.push_back({{"muscle", d.muscle},
                   {"coordinate", d.coordinate},
                   {"over", d.over},
                   {"length_mm", 1000 * d.length},
                   {at, shownValue(d.lengthAt, d.turns)},
                   {"slope_mm", 1000 * d.arm},
                   {"slope_" + at, shownValue(d.armAt, d.turns)},
                   {"opensim_jump_mm", 1000 * d.jump},
                   {"opensim_jump_" + at, shownValue(d.jumpAt, d.turns)},
                   {"not_computed", d.hasOthers}});
  }
  return all;
}

Table jumpTable(const std::vector<bio::LengthJump>& jumps) {
  Table table{"Jumps", {"muscle", "at", "length [mm]", "moment arm [mm]", "because of"}, {}};
  for (const bio::LengthJump& jump : jumps) {
    table.rows.push_back(
        {jump.muscle,
         fmt::format("{} {}", numberText(shownValue(jump.value, jump.turns)), unitOf(jump.turns)),
         inMillimetres(jump.size), inMillimetres(jump.arm),
         jump.conditional ? "a conditional point" : "the way round a wrap object"});
  }
  return table;
}

Table departureTable(const std::vector<bio::OpenSimDeparture>& departures) {
  Table table{"Where OpenSim's path differs from the taut string",
              {"muscle", "over", "length [mm]", "at", "slope of the length [mm]", "at",
               "OpenSim's length jumps [mm]"},
              {}};
  for (const bio::OpenSimDeparture& d : departures) {
    const auto where = [&](double value) {
      return fmt::format("{} {}", numberText(shownValue(value, d.turns)), unitOf(d.turns));
    };
    std::string over = fmt::format("{}", fmt::join(d.over, ", "));
    if (d.hasOthers) over += over.empty() ? "several or a torus: not computed" : ", and others";
    table.rows.push_back({d.muscle, over, inMillimetres(d.length), where(d.lengthAt),
                          inMillimetres(d.arm), where(d.armAt),
                          d.jump != 0 ? inMillimetres(d.jump) + " at " + where(d.jumpAt) : "no"});
  }
  return table;
}

std::string departureWords(const std::vector<bio::OpenSimDeparture>& departures) {
  const auto largest = std::max_element(
      departures.begin(), departures.end(),
      [](const auto& a, const auto& b) { return std::abs(a.length) < std::abs(b.length); });
  if (largest == departures.end()) return {};
  if (largest->length == 0) {
    return fmt::format(
        "{} of them go over several objects at once or a torus, where OpenSim's "
        "lengths may differ",
        departures.size());
  }
  return fmt::format("OpenSim's lengths of {} of them differ, by up to {} mm ({})",
                     departures.size(), inMillimetres(std::abs(largest->length)), largest->muscle);
}

}  // namespace app
