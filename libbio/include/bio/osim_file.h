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

/// Writes the model as a fresh OpenSim 4 document. The file appears whole or not at all.
/// @throws FileError if it cannot be written, or the model breaks a rule of model.h
/// @throws std::invalid_argument if a muscle is not a Schutte muscle, whose parameters Model lacks
void writeOsim(const Model& model, const std::filesystem::path& file);

/// Writes to `file` a copy of the document `original` that says what `model` says: numbers that
/// differ are replaced, forces and wrap objects added or removed; every other byte of content –
/// comments, pictures, controllers, classes that FisherHill does not know – stays. `file` may be
/// `original`.
/// @throws FileError as the two above
/// @throws std::invalid_argument if the document's form cannot express a change
void rewriteOsim(const std::filesystem::path& original, const Model& model,
                 const std::filesystem::path& file);

}  // namespace bio
