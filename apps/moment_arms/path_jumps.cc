#include "moment_arms/path_jumps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bio/model/units.h"
#include "output/text.h"

namespace app {
namespace {

/// [deg] or [mm]
double shownValue(double value, bool turns) {
  return turns ? value / bio::radiansPerDegree : 1000 * value;
}

std::string unitOf(bool turns) {
  return bio::positionUnit(turns).name;
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

nlohmann::ordered_json differencesAsJson(const std::vector<bio::OpenSimDifference>& differences) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const bio::OpenSimDifference& difference : differences) {
    const auto at = [&](double value) { return shownValue(value, difference.turns); };
    const std::string unit = unitOf(difference.turns);
    nlohmann::ordered_json apart = nlohmann::ordered_json::array();
    for (const auto& range : difference.apart) apart.push_back({at(range.from), at(range.to)});
    nlohmann::ordered_json jumps = nlohmann::ordered_json::array();
    for (const auto& jump : difference.jumps) {
      jumps.push_back({{"at_" + unit, at(jump.at)}, {"length_mm", 1000 * jump.size}});
    }
    all.push_back({{"muscle", difference.muscle},
                   {"coordinate", difference.coordinate},
                   {"ellipsoids", difference.ellipsoids},
                   {"length_mm", 1000 * difference.length},
                   {"length_at_" + unit, at(difference.lengthAt)},
                   {"moment_arm_mm", 1000 * difference.arm},
                   {"moment_arm_at_" + unit, at(difference.armAt)},
                   {"apart_" + unit, apart},
                   {"opensim_jumps", jumps}});
  }
  return all;
}

Table differenceTable(const std::vector<bio::OpenSimDifference>& differences) {
  Table table{"Paths over ellipsoids: OpenSim less the taut string",
              {"muscle", "over", "length [mm]", "moment arm [mm]",
               fmt::format("{} mm or more at", numberText(1000 * bio::leastOpenSimDifference)),
               "jumps of OpenSim's length [mm]"},
              {}};
  for (const bio::OpenSimDifference& difference : differences) {
    const std::string unit = unitOf(difference.turns);
    const auto at = [&](double value) {
      return numberText(shownValue(value, difference.turns), 3);
    };
    const auto largest = [&](double size, double where) {
      return fmt::format("{} at {} {}", inMillimetres(size), at(where), unit);
    };
    std::vector<std::string> apart, jumps;
    for (const auto& range : difference.apart) {
      apart.push_back(range.from < range.to
                          ? fmt::format("{} to {} {}", at(range.from), at(range.to), unit)
                          : fmt::format("{} {}", at(range.from), unit));
    }
    for (const auto& jump : difference.jumps) jumps.push_back(largest(jump.size, jump.at));
    table.rows.push_back(
        {difference.muscle, fmt::format("{}", fmt::join(difference.ellipsoids, ", ")),
         largest(difference.length, difference.lengthAt), largest(difference.arm, difference.armAt),
         fmt::format("{}", fmt::join(apart, ", ")),
         jumps.empty() ? "–" : fmt::format("{}", fmt::join(jumps, ", "))});
  }
  return table;
}

}  // namespace app
