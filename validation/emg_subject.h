#pragma once

#include "bio/model/model.h"

namespace validation {

/// The arm of the person behind emg_data/: the model, but
///     maximum isometric force    triceps heads +10 %, biceps heads −10 %, BRD +5 %
///     tendon slack length        +1 % in every muscle
///     radius of the cylinder TRI 17.5 mm
///     mass and inertia of ulna and radius (or forearm)  +5 %
///     damping of elbow_flexion   0.1 N m s/rad
/// A muscle or body that the model lacks is left out.
/// @throws std::invalid_argument if the model has no cylinder TRI
bio::Model subjectOf(bio::Model model);

/// The model with a damping of elbow_flexion and nothing else changed.
/// @param viscosity [N m s/rad]
bio::Model dampedArmOf(bio::Model model, double viscosity);

}  // namespace validation
