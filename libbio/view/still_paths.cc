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

std::vector<const MusclePath*> drawnPaths(const MusculoskeletalSystem& system,
                                          const StillPaths& still) {
  std::vector<const MusclePath*> paths;
  for (std::size_t i = 0; i < system.numPaths(); ++i) paths.push_back(&system.path(i));
  for (const MusclePath& path : still.paths) paths.push_back(&path);
  return paths;
}

std::vector<std::string> drawnPathNames(const MusculoskeletalSystem& system,
                                        const StillPaths& still) {
  std::vector<std::string> names;
  for (const SystemMuscle& muscle : system.muscles()) names.push_back(muscle.name);
  for (const SystemElasticPath& path : system.elasticPaths()) names.push_back(path.name);
  names.insert(names.end(), still.names.begin(), still.names.end());
  return names;
}

std::vector<std::string> drawnBodyNames(const Model& model) {
  std::vector<std::string> names{"ground"};
  for (const Body& body : model.bodies) names.push_back(body.name);
  return names;
}

}  // namespace bio::view
