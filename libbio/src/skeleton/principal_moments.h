#pragma once

// What an inertia tensor may be; not public.

#include <Eigen/Dense>

#include "bio/model/model.h"

namespace bio {

/// Principal moments of inertia about the mass centre, rising [kg m²].
Eigen::Vector3d principalMoments(const Body& body);

/// Whether the least of them is negative beyond rounding, which no distribution of mass has.
bool hasNegativeMoment(const Eigen::Vector3d& principal);

}  // namespace bio
