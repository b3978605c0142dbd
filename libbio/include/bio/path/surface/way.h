#pragma once

#include <Eigen/Dense>

#include "bio/path/surface/surface.h"

namespace bio {

/// The hint (ChainObject::hint) that leads a path from P to Q round a surface on a given side, all
/// in the surface's frame; for a quadrant as in OpenSim's files, `side` is ±x, ±y or ±z.
///
/// From the chord's deepest point, across the chord and towards the side, to where that leaves the
/// surface: the middle of the path lies on the named side, as with wrap_rule.h for cylinders
/// and spheres. Where the chord passes by the surface, the surface's farthest point on that side.
/// Decide once, in a reference posture, and keep it; OpenSim decides in every posture.
/// A torus is passed through its hole, whatever the side: the hint lies where the tube's inner side
/// is nearest to the chord.
/// @throws std::invalid_argument for a side that is no direction
Eigen::Vector3d hintTowards(const Surface& surface, const Eigen::Vector3d& side,
                            const Eigen::Vector3d& P, const Eigen::Vector3d& Q);

/// The hint of the shortest way round, for OpenSim's quadrant "all": of four that start towards the
/// nearest surface, away from it, and to either side, the one whose taut string is shortest.
Eigen::Vector3d hintOfShortest(const Surface& surface, const Eigen::Vector3d& P,
                               const Eigen::Vector3d& Q);

}  // namespace bio
