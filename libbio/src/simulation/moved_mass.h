#pragma once

// What a mass must be like to be moved; not public.

#include <Eigen/Dense>

#include "bio/model/model.h"
#include "bio/skeleton/skeleton.h"
#include "skeleton/principal_moments.h"

namespace bio {

/// Which free coordinate, or which of them together, move no mass in any posture; empty if all move
/// some, be it not in the default posture (see whatMovesNoMassAt).
std::string whatMovesNoMass(const Skeleton& skeleton);

/// The coordinates that move no mass in a posture q, though they do in others: rotations whose axes
/// coincide there, as the first and the last of Y-Z-Y at Z = 0. "coordinates 'y1', 'y2' can move
/// together without moving any mass"; empty if all move some.
std::string whatMovesNoMassAt(const Skeleton& skeleton, const Eigen::VectorXd& q);

/// Whether every coordinate moves mass of its own in the default posture already.
/// @throws std::invalid_argument if a free coordinate, or several together, move no mass in any
///   posture, or if a body that moves has a principal moment of inertia below −5 % of its largest
///   (rounded numbers of a flat body pass)
bool requireMovedMass(const Model& model, const Skeleton& skeleton);

}  // namespace bio
