#pragma once

#include <Eigen/Dense>
#include <optional>

#include "bio/path/surface/wrap_rule.h"

namespace bio::opensim_rule {

/// A path over an object as OpenSim finds it: straight to `first`, `length` over the surface,
/// straight on from `last`; in the object's frame [m].
struct OpenSimWrap {
  Eigen::Vector3d first, last;
  double length = 0;
};

/// OpenSim's rule for an ellipsoid, method "hybrid" (WrapEllipsoid, OpenSim 4.6), restated.
///
/// The path lies in the plane through P, Q and a point c of the surface. For a chord nearly along a
/// principal axis (cosine > 0.9) c is the point of the surface that is closest, in two dimensions,
/// to where the chord crosses that axis's plane; below 0.7073 the mean direction of 298 closest
/// points along the chord; in between a blend, which fades near the chord's ends. A quadrant flips
/// c to its side. The arc is a sum of chords of about 1 mm, equal angles apart.
///
/// Tangent points are exact here, OpenSim's to 1e-4 of the mean semi-axis. Nothing if the path is
/// straight: an end inside, ends in one direction, or no cut.
std::optional<OpenSimWrap> openSimOverEllipsoid(const Eigen::Vector3d& semiAxes,
                                                WrapQuadrant quadrant, const Eigen::Vector3d& P,
                                                const Eigen::Vector3d& Q);

}  // namespace bio::opensim_rule
