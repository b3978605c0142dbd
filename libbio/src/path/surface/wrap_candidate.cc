#include "path/surface/wrap_candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "path/surface/cylinder_of_ellipsoid.h"

namespace bio {
namespace {

// A sphere if all semi-axes are equal, a cylinder if asked for; else false.
bool ellipsoidAsSurface(const WrapObject& object, const std::vector<std::string>& wrapAsCylinder,
                        CandidateWrap& candidate, PathSurface& surface) {
  if (hasEqualSemiAxes(object.semiAxes)) {
    surface.isSphere = true;
    surface.radius = object.semiAxes[0];
    return true;
  }
  const auto& names = wrapAsCylinder;
  if (std::find(names.begin(), names.end(), object.name) == names.end()) return false;
  const CylinderOfEllipsoid cylinder = cylinderOf(object);
  candidate.X_SC.R = (candidate.X_SC.R * cylinder.turn).eval();
  surface.radius = cylinder.radius;
  surface.halfLength = cylinder.halfLength;
  surface.quadrant = cylinder.quadrant;
  return true;
}

// The surface of an ellipsoid or a torus.
Surface generalSurface(const WrapObject& object) {
  try {
    if (object.shape == WrapShape::torus) return TorusSurface(object.outerRadius, object.radius);
    return EllipsoidSurface(object.semiAxes);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(fmt::format("wrap object '{}': {}", object.name, e.what()));
  }
}

}  // namespace

CandidateWrap candidateWrap(const WrapObject& object, const BodyPlacement& place, std::size_t index,
                            const std::vector<std::string>& wrapAsCylinder) {
  CandidateWrap candidate;
  candidate.name = object.name;
  candidate.segment = place.segment;
  candidate.X_SC = place.X_SB * placementOf(object.frame);
  PathSurface surface;
  surface.wrap = index;
  surface.segment = candidate.segment;
  surface.quadrant = wrapQuadrant(object.quadrant);
  switch (object.shape) {
    case WrapShape::cylinder:
      surface.radius = object.radius;
      surface.halfLength = object.length / 2;
      break;
    case WrapShape::sphere:
      surface.isSphere = true;
      surface.radius = object.radius;
      break;
    case WrapShape::torus:
      surface.general = generalSurface(object);
      surface.radius = object.outerRadius;
      break;
    case WrapShape::ellipsoid:
      if (!ellipsoidAsSurface(object, wrapAsCylinder, candidate, surface)) {
        surface.general = generalSurface(object);
        surface.radius = object.semiAxes.x();
      }
      break;
  }
  if (!(surface.radius > 0)) {
    throw std::invalid_argument(
        fmt::format("wrap object '{}': radius = {} m, must be > 0", object.name, surface.radius));
  }
  const bool alongAxis =
      surface.quadrant == WrapQuadrant::plusZ || surface.quadrant == WrapQuadrant::minusZ;
  if (alongAxis && !surface.isSphere && !surface.general) {
    throw std::invalid_argument(
        fmt::format("wrap object '{}': quadrant {} lies along the cylinder's axis, must be across",
                    object.name, object.quadrant));
  }
  surface.X_SC = candidate.X_SC;
  candidate.shape = surface;
  return candidate;
}

}  // namespace bio
