#pragma once

#include "bio/model/model.h"

namespace validation {

/// The arm of the person behind emg_data/: the model, but
///     maximum isometric force    triceps heads +10 %, biceps heads −10 %, BRD +5 %
///     tendon slack length        +1 % in every muscle
///     radius of the cylinder TRI 17.5 mm
///     mass and inertia of ulna and radius  +5 %
///     damping of elbow_flexion   0.1 N m s/rad
/// @throws std::invalid_argument if the model has no such muscle, cylinder or body
bio::Model subjectOf(bio::Model model);

}  // namespace validation
