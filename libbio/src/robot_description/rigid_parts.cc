#include "robot_description/rigid_parts.h"

#include <cmath>

namespace bio::robot {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Transform operator*(const Transform& X_AB, const Transform& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p};
}

FramePlacement placementOf(const Transform& transform) {
  const Matrix3d& R = transform.R;
  FramePlacement placement{transform.p, Vector3d::Zero()};
  if (R.isIdentity(0)) return placement;
  // γ after α, so that the product is R where β is a right angle, too
  const double alpha = std::atan2(-R(1, 2), R(2, 2));
  const double beta = std::atan2(R(0, 2), std::hypot(R(1, 2), R(2, 2)));
  const double s = std::sin(alpha), c = std::cos(alpha);
  const double gamma = std::atan2(c * R(1, 0) + s * R(2, 0), c * R(1, 1) + s * R(2, 1));
  placement.orientation = Vector3d(alpha, beta, gamma).array() + 0.0;  // no −0
  return placement;
}

Matrix3d fromRollPitchYaw(const Vector3d& rpy) {
  if (rpy.isZero(0)) return Matrix3d::Identity();
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Matrix3d carryingZTo(const Vector3d& direction) {
  const Vector3d unit = direction.normalized();
  const Vector3d axis = Vector3d::UnitZ().cross(unit);
  const double sine = axis.norm();
  if (sine < 1e-10) {
    return unit.z() > 0 ? Matrix3d::Identity()
                        : AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  }
  return AngleAxisd(std::atan2(sine, unit.z()), axis / sine).toRotationMatrix();
}

MassProperties MassProperties::placed(const Transform& X) const {
  return {mass, X.R * center + X.p, X.R * inertia * X.R.transpose()};
}

MassProperties sum(const std::vector<MassProperties>& parts) {
  MassProperties whole;
  for (const MassProperties& part : parts) {
    whole.mass += part.mass;
    whole.center += part.mass * part.center;
  }
  if (!(whole.mass > 0)) return {};
  whole.center /= whole.mass;
  for (const MassProperties& part : parts) {
    const Vector3d d = part.center - whole.center;
    whole.inertia +=
        part.inertia + part.mass * (d.squaredNorm() * Matrix3d::Identity() - d * d.transpose());
  }
  return whole;
}

namespace {

MassProperties diagonal(double mass, double xx, double yy, double zz) {
  return {mass, Vector3d::Zero(), Vector3d(xx, yy, zz).asDiagonal()};
}

// m/k·(the other two sizes squared)
MassProperties ofSizes(double mass, const Vector3d& sizes, double k) {
  const Vector3d s = sizes.array().square();
  return diagonal(mass, mass / k * (s.y() + s.z()), mass / k * (s.x() + s.z()),
                  mass / k * (s.x() + s.y()));
}

}  // namespace

MassProperties ellipsoid(double mass, const Vector3d& semiAxes) {
  return ofSizes(mass, semiAxes, 5);
}

MassProperties box(double mass, const Vector3d& halfSizes) {
  return ofSizes(mass, halfSizes, 3);
}

MassProperties cylinder(double mass, double radius, double halfLength) {
  const double across = mass * (radius * radius / 4 + halfLength * halfLength / 3);
  return diagonal(mass, across, across, mass * radius * radius / 2);
}

MassProperties capsule(double mass, double radius, double halfLength) {
  // volumes over πr²: 2·halfLength of the middle, 4r/3 of the ends
  const double ends = mass * 4 * radius / (4 * radius + 6 * halfLength), middle = mass - ends;
  const double r = radius, h = halfLength;
  // either half ball has its centre 3r/8 beyond the end of the middle
  const double acrossEnds = ends * (2 * r * r / 5 + h * h + 3 * h * r / 4);
  const MassProperties tube = cylinder(middle, r, h);
  const double across = tube.inertia(0, 0) + acrossEnds;
  return diagonal(mass, across, across, tube.inertia(2, 2) + ends * 2 * r * r / 5);
}

}  // namespace bio::robot
