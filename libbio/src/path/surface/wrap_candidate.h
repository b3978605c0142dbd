#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// A wrap of a path.
struct CandidateWrap {
  std::string name;
  std::size_t firstPoint = 0, lastPoint = 0;  ///< in Path::points
  std::size_t segment = 0;
  Placement<double> X_SC;
  PathSurface shape;
  std::size_t surface = 0;  ///< of `shape` in CompiledPath::surfaces
};

/// Cylinders and spheres as they are, ellipsoids with three equal semi-axes as spheres, those named
/// in `wrapAsCylinder` as cylinders, other ellipsoids and tori as general surfaces. Points and
/// place in CompiledPath::surfaces are the caller's.
/// @param index  its place in Path::wraps
/// @throws std::invalid_argument a radius or semi-axis ≤ 0, a torus without a hole, a quadrant
///   along a cylinder's axis, an ellipsoid to be a cylinder without two equal semi-axes
CandidateWrap candidateWrap(const WrapObject& object, const BodyPlacement& place, std::size_t index,
                            const std::vector<std::string>& wrapAsCylinder);

}  // namespace bio
