#include "moment_arms/path_jumps.h"

#include <fmt/format.h>

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

}  // namespace app
