#pragma once

#include <filesystem>
#include <string>

#include "bio/model/model.h"

namespace bio {

/// Reads an OpenSim 3 (joints nested in bodies) or OpenSim 4 (sockets and offset frames) model, or
/// a robot description (URDF, MJCF), which is translated to an OpenSim 4 document first
/// (bio/robot_description). The root element says which it is, not the suffix.
///
/// Read are: bodies, joints (Weld, Pin, Slider, Universal, Planar, Gimbal, Free, Custom),
/// coordinates, CoordinateCouplerConstraint, wrap objects, paths of all muscles, parameters of
/// those of simulatedClasses(), CoordinateLimitForce, SpringGeneralizedForce,
/// ExpressionBasedCoordinateForce, PointToPointSpring, BushingForce, Ligament, PathSpring,
/// Blankevoort1991Ligament, PrescribedForce, CoordinateActuator. Offset frames are folded into
/// their bodies. For missing elements the model's <defaults> apply, then OpenSim's own defaults:
/// mass_center 0, inertia 0, coordinate 0 in ±10, quadrant all, F0 1000 N, ℓ0 0.1 m, ℓs 0.2 m,
/// pennation 0, damping 0.1, and the curves of the Schutte class. Masses and sizes of wrap objects
/// must be given. Elements that would act in OpenSim but are not simulated are listed in
/// Model::warnings.
///
/// @throws FileError if the file cannot be read, is not a model, or breaks a rule of model.h
Model readOsim(const std::filesystem::path& file);

/// Writes the model as a fresh OpenSim 4 document. The file appears complete or not at all.
/// @throws FileError if it cannot be written, or the model breaks a rule of model.h
/// @throws std::invalid_argument if a muscle is not of simulatedClasses(), so that Model lacks its
/// numbers
void writeOsim(const Model& model, const std::filesystem::path& file);

/// The document `original`, changed to describe `model`: numbers that differ are replaced, forces
/// and wrap objects added or removed; all other content (comments, pictures, controllers, unknown
/// classes) is kept. Of a robot description it is the OpenSim 4 document to which that is
/// translated.
/// @param name  of the new document, for messages
/// @throws FileError as the two above
/// @throws std::invalid_argument if the document cannot express a change
std::string rewrittenOsim(const std::filesystem::path& original, const Model& model,
                          const std::string& name);

/// Writes rewrittenOsim(); `file` may be `original`.
/// @throws what rewrittenOsim throws; FileError if it cannot be written
void rewriteOsim(const std::filesystem::path& original, const Model& model,
                 const std::filesystem::path& file);

}  // namespace bio
