#pragma once

#include <string>
#include <vector>

#include "score/discovery_score.h"

namespace hidden {

/// The suites whose sets are not like those that the targets are about: "far", of people and trials
/// far from the nominal model, and "violated", whose data break an assumption.
bool isHard(const Outcome& outcome);

/// What verdicts on sets of one kind are worth.
struct HardRow {
  std::string kind;                    ///< of far "all"; of violated the violation's id
  int sets = 0;                        ///< all of them
  int nothing = 0, alarms = 0;         ///< with nothing hidden, and of those with a claim
  int parameters = 0, structures = 0;  ///< with a parameter, and of those with a structure named
  int effects = 0, right = 0;          ///< with an effect or a parameter, the right name first
  int confidentlyWrong = 0;            ///< of all
  std::vector<std::string> wrong;      ///< their names, and those of alarms and structures
};

/// One row for suite far, then one for every violation that occurs, in their names' order; then
/// "violated", all of these. Rows without sets are left out.
std::vector<HardRow> hardRows(const std::vector<Outcome>& outcomes);

/// As Markdown with Wilson's 95 % intervals; empty without such sets.
std::string hardTable(const std::vector<Outcome>& outcomes);
Json hardJson(const std::vector<Outcome>& outcomes);

}  // namespace hidden
