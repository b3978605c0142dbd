#include "path/surface/wrap_candidate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

// A sphere if all semi-axes are equal, a cylinder if asked for; else false.
bool ellipsoidAsSurface(const WrapObject& object, const std::vector<std::string>& wrapAsCylinder,
                        CandidateWrap& candidate, PathSurface& surface) {
  const Vec3<double>& s = object.semiAxes;
  const auto equal = [&](int i, int j) { return std::abs(s[i] - s[j]) <= 1e-9 * s[i]; };
  if (equal(0, 1) && equal(1, 2)) {
    surface.isSphere = true;
    surface.radius = s[0];
    return true;
  }
  const auto& names = wrapAsCylinder;
  if (std::find(names.begin(), names.end(), object.name) == names.end()) return false;
  // the axis is the odd one out; a cyclic change of axes makes it z
  int axis = -1;
  for (int k = 0; k < 3; ++k) {
    if (equal((k + 1) % 3, (k + 2) % 3)) axis = k;
  }
  if (axis < 0) {
    throw std::invalid_argument(
        fmt::format("wrap object '{}' cannot be treated as a cylinder: its semi-axes are {}, {} "
                    "and {} m, two must be equal",
                    object.name, s[0], s[1], s[2]));
  }
  Mat3<double> turn = Mat3<double>::Zero();  // columns: new x, y, z in the old frame
  for (int k = 0; k < 3; ++k) turn((axis + 1 + k) % 3, k) = 1;
  candidate.X_SC.R = (candidate.X_SC.R * turn).eval();
  surface.radius = s[(axis + 1) % 3];
  surface.halfLength = s[axis];
  if (surface.quadrant != WrapQuadrant::all) {
    const int code = static_cast<int>(surface.quadrant) - 1;  // 2·axis + (minus)
    const int turned = (code / 2 - axis - 1 + 6) % 3;
    surface.quadrant = static_cast<WrapQuadrant>(1 + 2 * turned + code % 2);
  }
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
