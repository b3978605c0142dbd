#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/path/path.h"
#include "bio/simulation/musculoskeletal_system.h"

namespace bio::view {

/// Paths of the muscles that no free coordinate of a system moves: they are not simulated, but
/// drawn.
struct StillPaths {
  std::vector<std::string> names;
  std::vector<MusclePath> paths;
};

/// Muscles that are switched off, whose path is a function of coordinates or whose wraps are not
/// supported have none.
/// @param system  of the model
/// @throws std::invalid_argument what MusclePath throws
StillPaths stillPaths(const Model& model, const MusculoskeletalSystem& system,
                      const std::vector<std::string>& wrapAsCylinder);

/// What is drawn of a system: its muscles, its elastic paths, then the still ones. They are valid
/// as long as both arguments.
std::vector<const MusclePath*> drawnPaths(const MusculoskeletalSystem& system,
                                          const StillPaths& still);
/// Their names.
std::vector<std::string> drawnPathNames(const MusculoskeletalSystem& system,
                                        const StillPaths& still);

/// The bodies in the order of bodyShapes().
std::vector<std::string> drawnBodyNames(const Model& model);

}  // namespace bio::view
