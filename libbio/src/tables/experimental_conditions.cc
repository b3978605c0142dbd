#include "bio/tables/experimental_conditions.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "bio/model/units.h"

namespace bio {
namespace {

constexpr const char* massLine = "known_mass_in_hand_kg";
constexpr const char* turnLine = "known_arm_turn_deg";

// As somebody would write it: -45, not -45.00000000000001.
std::string inDegrees(double angle) {
  return fmt::format("{:.12g}", angle / radiansPerDegree);
}

double numberOf(const std::map<std::string, std::string>& header, const char* name, double lowest,
                double highest) {
  const auto at = header.find(name);
  if (at == header.end()) return 0;
  double value = 0;
  const char* last = at->second.data() + at->second.size();
  const auto [end, error] = std::from_chars(at->second.data(), last, value);
  if (error != std::errc() || end != last || !(value >= lowest && value <= highest)) {
    throw std::invalid_argument(fmt::format("header: {} = '{}', must be a number from {} to {}",
                                            name, at->second, lowest, highest));
  }
  return value;
}

}  // namespace

std::string inWords(const ExperimentalConditions& conditions) {
  std::string words;
  if (conditions.massInHand != 0)
    words = fmt::format("with a known mass of {} kg", conditions.massInHand);
  if (conditions.armTurn != 0) {
    words += fmt::format("{} the limb turned by {} deg", words.empty() ? "with" : " and",
                         inDegrees(conditions.armTurn));
  }
  return words;
}

std::map<std::string, std::string> headerOf(const ExperimentalConditions& conditions) {
  std::map<std::string, std::string> header;
  if (conditions.massInHand != 0) header[massLine] = fmt::format("{}", conditions.massInHand);
  if (conditions.armTurn != 0) header[turnLine] = inDegrees(conditions.armTurn);
  return header;
}

const std::vector<std::string>& knownLines() {
  static const std::vector<std::string> names = {massLine, turnLine};
  return names;
}

ExperimentalConditions experimentalConditionsIn(const std::map<std::string, std::string>& header) {
  return {numberOf(header, massLine, 0, 100),
          numberOf(header, turnLine, -180, 180) * radiansPerDegree};
}

}  // namespace bio
