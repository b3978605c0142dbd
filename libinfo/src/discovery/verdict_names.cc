#include "info/discovery/discover.h"

namespace info::discover {

const char* name(Finding finding) {
  static constexpr const char* kNames[] = {"none",      "parameter", "named",
                                           "ambiguous", "unknown",   "numerical"};
  return kNames[static_cast<int>(finding)];
}
const char* name(Stage stage) {
  static constexpr const char* kNames[] = {"calibrate", "localise", "screen",
                                           "race",      "decide",   "finished"};
  return kNames[static_cast<int>(stage)];
}
const char* name(EffectKind kind) {
  static constexpr const char* kNames[] = {"structure", "input", "geometry", "sensor", "parameter"};
  return kNames[static_cast<int>(kind)];
}

const char* name(NonparametricForce::Follows follows) {
  return follows == NonparametricForce::Follows::position ? "position" : "speed";
}

}  // namespace info::discover
