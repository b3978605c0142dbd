#pragma once

#include <string>

#include "bio/analysis/replay.h"
#include "bio/opensim/osim_file.h"
#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio::fixtures {

/// A shipped model with a shipped trial, the elbow free.
struct ShippedElbow {
  explicit ShippedElbow(const std::string& modelName = "elbow8",
                        const std::string& trialName = "curl_slow", EmgMapping mapping = {})
      : model(readOsim(root() + "/models/" + modelName + ".osim")),
        system(model, options()),
        trial(readTrial(root() + "/emg_data/" + trialName + ".sto", model)),
        excitation(excitationOf(trial, system)),
        catalogue(model, system, {startCoordinates(trial, system, {}), {}}, mapping) {}

  static std::string root() { return FISHERHILL_SOURCE_DIR; }
  static SystemOptions options() { return {{{"elbow_flexion"}, {}}, {}, {}}; }

  Model model;
  MusculoskeletalSystem system;
  Trial trial;
  ExcitationSignal excitation;
  ParameterCatalogue catalogue;
};

inline SimulationOptions forSeconds(double duration) {
  SimulationOptions options;
  options.duration = duration;
  return options;
}

}  // namespace bio::fixtures
