#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "bio/model/model.h"

/// Placements and masses of the parts of a robot.
namespace bio::robot {

/// p_A = R p_B + p of a frame B in A.
struct Transform {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};
Transform operator*(const Transform& X_AB, const Transform& X_BC);

/// R = R_x(α) R_y(β) R_z(γ)
FramePlacement placementOf(const Transform& transform);
/// A turn by roll about x, then by pitch about y, then by yaw about z of the outer frame.
Eigen::Matrix3d fromRollPitchYaw(const Eigen::Vector3d& rpy);
/// The smallest turn that carries z to the direction; half a turn about x for −z.
Eigen::Matrix3d carryingZTo(const Eigen::Vector3d& direction);

struct MassProperties {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< in the frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre, axes of the frame
  MassProperties placed(const Transform& X) const;    ///< the same, seen from X's outer frame
};
MassProperties sum(const std::vector<MassProperties>& parts);

// Homogeneous solids about their own centre, the axis of round ones along z.
MassProperties ellipsoid(double mass, const Eigen::Vector3d& semiAxes);
MassProperties box(double mass, const Eigen::Vector3d& halfSizes);
MassProperties cylinder(double mass, double radius, double halfLength);
/// A cylinder with half a ball on either end.
MassProperties capsule(double mass, double radius, double halfLength);

}  // namespace bio::robot
