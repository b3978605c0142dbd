#pragma once

// How a bushing is deflected; not public.

#include <algorithm>
#include <cmath>

#include "bio/forces/body_forces.h"

namespace bio {

/// The frames F and M of a bushing in a posture, its deflection (θ, d), and what changes it. With E
/// the rates of the angles' axes in F, ω_F = E θ̇.
struct BushingDeflection {
  BushingDeflection(const Placement<double>& inFirst, const Placement<double>& X_M)
      : X_F(inFirst), p(X_M.p) {
    const Eigen::Matrix3d R = X_F.R.transpose() * X_M.R;
    value << std::atan2(-R(1, 2), R(2, 2)), std::asin(std::clamp(R(0, 2), -1.0, 1.0)),
        std::atan2(-R(0, 1), R(0, 0)), X_F.R.transpose() * (p - X_F.p);
    const Eigen::AngleAxisd first(value[0], Eigen::Vector3d::UnitX());
    E.col(0) = Eigen::Vector3d::UnitX();
    E.col(1) = first * Eigen::Vector3d::UnitY();
    E.col(2) = R.col(2);
    perE = E.inverse();
  }

  /// Relative turn of M, and motion of its origin, in F, by screws of both bodies.
  Vector6 relative(const Vector6& onFirst, const Vector6& onSecond) const {
    Vector6 r;
    const Vector6 apart = onSecond - onFirst;
    r << X_F.R.transpose() * apart.head<3>(),
        X_F.R.transpose() * (apart.tail<3>() + apart.head<3>().cross(p));
    return r;
  }
  /// ∂_k of the deflection, from the screws of coordinate k.
  Vector6 slope(const Vector6& onFirst, const Vector6& onSecond) const {
    Vector6 d = relative(onFirst, onSecond);
    d.head<3>() = perE * d.head<3>();
    return d;
  }

  Placement<double> X_F;
  Eigen::Vector3d p;  ///< M's origin in the ground [m]
  Vector6 value;      ///< θ [rad], d [m]
  Eigen::Matrix3d E, perE;
};

}  // namespace bio
