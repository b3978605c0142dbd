#pragma once

// What a mass must be like to be moved; not public.

#include <Eigen/Dense>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"
#include "skeleton/principal_moments.h"

namespace bio {

/// Which free coordinate, or which of them together, move no mass in the default posture; empty if
/// all move some.
std::string whatMovesNoMass(const Skeleton& skeleton);

/// @throws std::invalid_argument if a free coordinate, or several together, move no mass in the
///   default posture, or if a body that moves has a principal moment of inertia below
///   −5 % of its largest (rounded numbers of a flat body pass)
void requireMovedMass(const Model& model, const Skeleton& skeleton);

}  // namespace bio
