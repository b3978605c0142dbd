#include "bio/path/with_cylinders.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/skeleton/skeleton.h"
#include "path/surface/cylinder_of_ellipsoid.h"

namespace bio {
namespace {

/// Body-fixed x-y-z angles, the inverse of placementOf(): R = R_x R_y R_z. Exact at β = ±π/2, too,
/// where only α ± γ counts: α is taken from R R_z⁻¹ = R_x R_y. Eigen's eulerAngles takes the first
/// angle from [0, π], so that small ones would be written as others near π.
Eigen::Vector3d bodyFixedAngles(const Mat3<double>& R) {
  const double gamma = std::atan2(-R(0, 1), R(0, 0));
  const double c = std::cos(gamma), s = std::sin(gamma);
  const double beta = std::atan2(R(0, 2), c * R(0, 0) - s * R(0, 1));
  const double alpha = std::atan2(s * R(2, 0) + c * R(2, 1), s * R(1, 0) + c * R(1, 1));
  return {alpha, beta, gamma};
}

const char* nameOfQuadrant(WrapQuadrant quadrant) {
  switch (quadrant) {
    case WrapQuadrant::plusX:
      return "x";
    case WrapQuadrant::minusX:
      return "-x";
    case WrapQuadrant::plusY:
      return "y";
    case WrapQuadrant::minusY:
      return "-y";
    case WrapQuadrant::plusZ:
      return "z";
    case WrapQuadrant::minusZ:
      return "-z";
    case WrapQuadrant::all:
      break;
  }
  return "all";
}

}  // namespace

Model withCylinders(Model model, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto index = &findWrapObject(model, name) - model.wrapObjects.data();
    WrapObject& object = model.wrapObjects[static_cast<std::size_t>(index)];
    if (object.shape != WrapShape::ellipsoid || hasEqualSemiAxes(object.semiAxes)) continue;
    const CylinderOfEllipsoid cylinder = cylinderOf(object);
    if (!cylinder.turn.isIdentity(0)) {
      object.frame.orientation = bodyFixedAngles(placementOf(object.frame).R * cylinder.turn);
    }
    object.shape = WrapShape::cylinder;
    object.radius = cylinder.radius;
    object.length = 2 * cylinder.halfLength;
    object.quadrant = nameOfQuadrant(cylinder.quadrant);
    object.semiAxes.setZero();
    model.remarks.push_back(
        fmt::format("wrap object '{}' is a cylinder in place of its ellipsoid, as asked", name));
  }
  return model;
}

}  // namespace bio
