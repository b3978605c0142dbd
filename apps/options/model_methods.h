#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "output/methods.h"

namespace app {

/// What is to be said of a model that is simulated: its coordinates, the classes of its muscles,
/// its paths.
void sayModel(const bio::Model& model, const bio::MusculoskeletalSystem& system, Methods& methods);

/// What is to be said of the paths of these muscles.
void sayPaths(const bio::Model& model, const std::vector<std::string>& muscles, Methods& methods);

/// That these ellipsoids were taken as cylinders, if there are any.
void sayCylinders(const std::vector<std::string>& wrapAsCylinder, Methods& methods);

/// What is to be said of trials whose excitations drive the model.
void sayExcitations(const bio::MusculoskeletalSystem& system, Methods& methods);

}  // namespace app
