#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// A wrap of a path: a surface that can be evaluated, or the ellipsoid around one that cannot.
struct CandidateWrap {
  std::string name;
  std::size_t firstPoint = 0, lastPoint = 0;  ///< in Path::points
  std::size_t segment = 0;
  Placement<double> X_SC;
  std::optional<PathSurface> shape;              ///< what can be evaluated
  std::size_t surface = 0;                       ///< of `shape` in CompiledPath::surfaces
  Vec3<double> semiAxes = Vec3<double>::Zero();  ///< without shape
  bool isTorus = false;
};

/// Cylinders and spheres as they are, ellipsoids with three equal semi-axes as spheres, those named
/// in `wrapAsCylinder` as cylinders. Points and place in CompiledPath::surfaces are the caller's.
/// @param index  its place in Path::wraps
/// @throws std::invalid_argument a radius ≤ 0, a quadrant along a cylinder's axis, an ellipsoid to
///   be a cylinder without two equal semi-axes
CandidateWrap candidateWrap(const WrapObject& object, const BodyPlacement& place, std::size_t index,
                            const std::vector<std::string>& wrapAsCylinder);

}  // namespace bio
