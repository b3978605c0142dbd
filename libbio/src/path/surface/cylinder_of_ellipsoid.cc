#include "path/surface/cylinder_of_ellipsoid.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

bool equalSemiAxes(const Vec3<double>& s, int i, int j) {
  return std::abs(s[i] - s[j]) <= 1e-9 * s[i];
}

}  // namespace

bool hasEqualSemiAxes(const Vec3<double>& semiAxes) {
  return equalSemiAxes(semiAxes, 0, 1) && equalSemiAxes(semiAxes, 1, 2);
}

CylinderOfEllipsoid cylinderOf(const WrapObject& ellipsoid) {
  const Vec3<double>& s = ellipsoid.semiAxes;
  // the axis is the odd one out; a cyclic change of axes makes it z
  int axis = -1;
  for (int k = 0; k < 3; ++k) {
    if (equalSemiAxes(s, (k + 1) % 3, (k + 2) % 3)) axis = k;
  }
  if (axis < 0) {
    throw std::invalid_argument(
        fmt::format("wrap object '{}' cannot be treated as a cylinder: its semi-axes are {}, {} "
                    "and {} m, two must be equal",
                    ellipsoid.name, s[0], s[1], s[2]));
  }
  CylinderOfEllipsoid cylinder;
  cylinder.turn.setZero();  // columns: new x, y, z in the old frame
  for (int k = 0; k < 3; ++k) cylinder.turn((axis + 1 + k) % 3, k) = 1;
  cylinder.radius = s[(axis + 1) % 3];
  cylinder.halfLength = s[axis];
  cylinder.quadrant = wrapQuadrant(ellipsoid.quadrant);
  if (cylinder.quadrant != WrapQuadrant::all) {
    const int code = static_cast<int>(cylinder.quadrant) - 1;  // 2·axis + (minus)
    const int turned = (code / 2 - axis - 1 + 6) % 3;
    cylinder.quadrant = static_cast<WrapQuadrant>(1 + 2 * turned + code % 2);
  }
  return cylinder;
}

}  // namespace bio
