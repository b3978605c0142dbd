#pragma once

#include <string>
#include <vector>

#include "bio/model/model.h"

namespace bio {

/// The model with wrap cylinders in place of the named ellipsoids: what SystemOptions'
/// wrapAsCylinder does to their paths, as a model. The odd semi-axis is the cylinder's axis z and
/// half its length, the equal ones are its radius; the frame is turned so that this axis is z, so
/// that its orientation is that of the cylinder. Objects of another shape, and ellipsoids that are
/// spheres, stay as they are. Each replacement is a remark of the model.
/// @throws std::invalid_argument for a name that is no wrap object's, an ellipsoid without two
///   equal semi-axes, a quadrant that is not one
Model withCylinders(Model model, const std::vector<std::string>& names);

}  // namespace bio
