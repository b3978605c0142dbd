#pragma once

#include <Eigen/Dense>
#include <variant>

#include "bio/path/surface/ellipsoid_surface.h"
#include "bio/path/surface/round_surfaces.h"
#include "bio/path/surface/torus_surface.h"

namespace bio {

/// Any surface that a path can lie on. A new one is a class that satisfies ImplicitSurface and an
/// entry here; bio/path/surface/geodesic.h integrates over it by its derivatives alone.
using Surface = std::variant<SphereSurface, CylinderSurface, EllipsoidSurface, TorusSurface>;

/// The most numbers of its own that a surface has.
inline constexpr int maxSurfaceNumbers = 3;

/// How many numbers of its own a surface has.
int numNumbersOf(const Surface& surface);

/// A length [m] of the surface's size.
double sizeOf(const Surface& surface);

/// Where a segment is deepest in a surface.
struct LowestPoint {
  double height;  ///< g/(|∇g|) about there [m], < 0 inside: how far from the surface, roughly
  Eigen::Vector3d point;
};

/// The point of the segment from x to y where g is least. For a torus the least of 32 samples,
/// refined.
LowestPoint lowestOnSegment(const Surface& surface, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& y);

/// Whether a point lies inside a surface, or on it to 1e-12 of its size.
bool isInside(const Surface& surface, const Eigen::Vector3d& x);

}  // namespace bio
