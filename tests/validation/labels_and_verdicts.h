#pragma once

#include <string>
#include <vector>

#include "score/discovery_score.h"

/// Labels and verdicts in the least words.
namespace hidden {

inline Json truthOf(const std::string& id, double value,
                    std::vector<std::string> equivalents = {}) {
  return {{"id", id},
          {"readings", Json::array({{{"name", "b"}, {"unit", "N m s"}, {"value", value}}})},
          {"equivalents", equivalents}};
}

inline Json labelOf(const std::string& suite, const Json& effects, double size = 1,
                    double noise = 0) {
  return {{"suite", suite}, {"size", size}, {"emg_noise", noise}, {"effects", effects}};
}

inline Json effectOf(const std::string& id, const std::string& kind, double probability,
                     double value = 0, double sd = 1, const std::string& parameter = "b",
                     const std::string& unit = "N m s") {
  return {{"id", id},
          {"kind", kind},
          {"probability", probability},
          {"parameters", {{parameter, {{"value", value}, {"sd", sd}, {"unit", unit}}}}}};
}

inline Json verdictOf(const std::string& word, const Json& effects,
                      const Json& inClass = Json::array()) {
  return {{"verdict", word}, {"effects", effects}, {"class", inClass}};
}

}  // namespace hidden
