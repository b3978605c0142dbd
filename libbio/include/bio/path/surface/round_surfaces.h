#pragma once

#include "bio/path/surface/implicit_surface.h"

namespace bio {

/// Sphere g = ½(|x|² − r²), radius r [m] > 0. Where it is alone on a span, bio/wrap_sphere.h is
/// the closed form of the same path.
class SphereSurface {
 public:
  static constexpr int numNumbers = 1;

  /// @throws std::invalid_argument for a radius that is not > 0
  explicit SphereSurface(double radius);

  double radius() const { return radius_; }
  double number(int) const { return radius_; }
  double size() const { return radius_; }
  double value(const Eigen::Vector3d& x) const {
    return 0.5 * (x.squaredNorm() - radius_ * radius_);
  }
  Eigen::Vector3d gradient(const Eigen::Vector3d& x) const { return x; }
  Eigen::Vector3d hessianTimes(const Eigen::Vector3d&, const Eigen::Vector3d& u) const { return u; }
  Eigen::Vector3d thirdTwice(const Eigen::Vector3d&, const Eigen::Vector3d&) const {
    return Eigen::Vector3d::Zero();
  }
  NumberDerivative ofNumber(const Eigen::Vector3d&, int) const {
    return {-radius_, Eigen::Vector3d::Zero()};
  }

 private:
  double radius_;
};
static_assert(ImplicitSurface<SphereSurface>);

/// Endless cylinder about z, g = ½(x² + y² − r²), radius r [m] > 0. Where it is alone on a span,
/// wrap_cylinder.h is the closed form of the same path.
class CylinderSurface {
 public:
  static constexpr int numNumbers = 1;

  /// @throws std::invalid_argument for a radius that is not > 0
  explicit CylinderSurface(double radius);

  double radius() const { return radius_; }
  double number(int) const { return radius_; }
  double size() const { return radius_; }
  double value(const Eigen::Vector3d& x) const {
    return 0.5 * (x[0] * x[0] + x[1] * x[1] - radius_ * radius_);
  }
  Eigen::Vector3d gradient(const Eigen::Vector3d& x) const { return {x[0], x[1], 0}; }
  Eigen::Vector3d hessianTimes(const Eigen::Vector3d&, const Eigen::Vector3d& u) const {
    return {u[0], u[1], 0};
  }
  Eigen::Vector3d thirdTwice(const Eigen::Vector3d&, const Eigen::Vector3d&) const {
    return Eigen::Vector3d::Zero();
  }
  NumberDerivative ofNumber(const Eigen::Vector3d&, int) const {
    return {-radius_, Eigen::Vector3d::Zero()};
  }

 private:
  double radius_;
};
static_assert(ImplicitSurface<CylinderSurface>);

}  // namespace bio
