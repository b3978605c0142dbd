#pragma once

#include "bio/model/model.h"
#include "bio/path/surface/wrap_rule.h"

namespace bio {

/// Whether all three are equal, to a relative 1e-9.
bool hasEqualSemiAxes(const Vec3<double>& semiAxes);

/// The cylinder that stands for an ellipsoid with two equal semi-axes.
struct CylinderOfEllipsoid {
  Mat3<double> turn;      ///< R_EC, a cyclic change of axes: the odd one is the cylinder's z
  double radius = 0;      ///< the equal semi-axes [m]
  double halfLength = 0;  ///< the odd one [m]
  WrapQuadrant quadrant = WrapQuadrant::all;  ///< in the cylinder's axes
};

/// @throws std::invalid_argument for an ellipsoid without two equal semi-axes, or a quadrant that
///   is not one
CylinderOfEllipsoid cylinderOf(const WrapObject& ellipsoid);

}  // namespace bio
