#include "view/still_paths.h"

#include <algorithm>

#include "bio/path/posture_samples.h"

namespace bio::view {

StillPaths stillPaths(const Model& model, const MusculoskeletalSystem& system,
                      const std::vector<std::string>& wrapAsCylinder) {
  StillPaths still;
  PostureSamples postures(model, system.skeleton());
  for (const Muscle& muscle : model.muscles) {
    const bool isSimulated =
        std::any_of(system.muscles().begin(), system.muscles().end(),
                    [&](const SystemMuscle& one) { return one.name == muscle.name; });
    if (!muscle.enabled || isSimulated) continue;
    try {
      MusclePath path(model, system.skeleton(), muscle, wrapAsCylinder, postures.of(muscle));
      if (path.isFunction()) continue;
      still.paths.push_back(std::move(path));
      still.names.push_back(muscle.name);
    } catch (const UnsupportedWrap&) {
      // whoever read the model has warned of it
    }
  }
  return still;
}

}  // namespace bio::view
