#pragma once

#include <filesystem>

#include "bio/model.h"

namespace bio {

/// Reads an OpenSim 3 (joints nested in bodies) or OpenSim 4 (sockets and offset frames) model.
///
/// Taken over: bodies, joints (Weld, Pin, Slider, Universal, Planar, Gimbal, Free, Custom),
/// coordinates, CoordinateCouplerConstraint, wrap objects, paths of all muscles, parameters of
/// Schutte1993Muscle_Deprecated, CoordinateLimitForce, SpringGeneralizedForce,
/// ExpressionBasedCoordinateForce. Offset frames are folded into their bodies. Where an element is
/// silent, the model's <defaults> speak, then OpenSim's own defaults: mass_center 0, inertia 0,
/// coordinate 0 in ±10, quadrant all, F0 1000 N, ℓ0 0.1 m, ℓs 0.2 m, pennation 0, damping 0.1, and
/// the curves of the Schutte class. Masses and sizes of wrap objects must be given. What would act
/// in OpenSim and is not simulated is named in Model::warnings.
///
/// @throws FileError if the file cannot be read, is not a model, or breaks a rule of model.h
Model readOsim(const std::filesystem::path& file);

}  // namespace bio
