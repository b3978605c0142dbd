#pragma once

#include "bio/path/surface/implicit_surface.h"

namespace bio {

/// Torus about z: g = ½((ρ − R)² + z² − r²), ρ² = x² + y². Its numbers: the radius R of the ring in
/// the middle of the tube and the radius r of the tube [m], R > r > 0. C∞ but on the axis ρ = 0.
class TorusSurface {
 public:
  static constexpr int numNumbers = 2;

  /// @throws std::invalid_argument if not ringRadius > tubeRadius > 0
  TorusSurface(double ringRadius, double tubeRadius);

  double ringRadius() const { return ring_; }
  double tubeRadius() const { return tube_; }
  double number(int i) const { return i == 0 ? ring_ : tube_; }
  double size() const { return ring_ + tube_; }
  double value(const Eigen::Vector3d& x) const {
    const double fromRing = rho(x) - ring_;
    return 0.5 * (fromRing * fromRing + x[2] * x[2] - tube_ * tube_);
  }
  Eigen::Vector3d gradient(const Eigen::Vector3d& x) const {
    const double shrink = 1 - ring_ / rho(x);
    return {shrink * x[0], shrink * x[1], x[2]};
  }
  /// ∇²g = 1 − (R/ρ) e_φ e_φᵀ
  Eigen::Vector3d hessianTimes(const Eigen::Vector3d& x, const Eigen::Vector3d& u) const {
    const double perRho = 1 / rho(x);
    const double around = ring_ * perRho * perRho * perRho * (x[0] * u[1] - x[1] * u[0]);
    return {u[0] + around * x[1], u[1] - around * x[0], u[2]};
  }
  /// Gradient of −R c²/ρ³, c = x u_y − y u_x.
  Eigen::Vector3d thirdTwice(const Eigen::Vector3d& x, const Eigen::Vector3d& u) const {
    const double perRho = 1 / rho(x);
    const double c = x[0] * u[1] - x[1] * u[0];
    const double factor = ring_ * c * perRho * perRho * perRho;
    const double inwards = 3 * factor * c * perRho * perRho;
    return {inwards * x[0] - 2 * factor * u[1], inwards * x[1] + 2 * factor * u[0], 0};
  }
  NumberDerivative ofNumber(const Eigen::Vector3d& x, int i) const {
    if (i == 1) return {-tube_, Eigen::Vector3d::Zero()};
    const double distance = rho(x);
    return {ring_ - distance, Eigen::Vector3d(-x[0] / distance, -x[1] / distance, 0)};
  }

  /// The geodesic equation without its velocity: along a geodesic Clairaut's c = x u_y − y u_x is
  /// constant, so that
  ///     x″ = −(1 − R c²/ρ³)/r² ∇g,   K = (ρ − R)/(r²ρ)
  class Flow {
   public:
    static constexpr double reach = 1.1;  ///< steps that extrapolation reaches in, found by trial
    Flow(const TorusSurface& surface, const Eigen::Vector3d& x, const Eigen::Vector3d& u)
        : ring_(surface.ring_), perTubeSquared_(1 / (surface.tube_ * surface.tube_)) {
      const double c = x[0] * u[1] - x[1] * u[0];
      ringClairaut_ = ring_ * c * c;
    }
    /// Writes x″ and returns Gauss's curvature K. T: double, or several side by side.
    template <class T>
    T accelerate(const T* x, T* acceleration) const {
      const T perRho = perRoot(x[0] * x[0] + x[1] * x[1]);
      const T pull = -(1.0 - ringClairaut_ * perRho * perRho * perRho) * perTubeSquared_;
      const T shrink = 1.0 - ring_ * perRho;
      acceleration[0] = pull * shrink * x[0];
      acceleration[1] = pull * shrink * x[1];
      acceleration[2] = pull * x[2];
      return shrink * perTubeSquared_;
    }

   private:
    static double perRoot(double square) { return 1 / std::sqrt(square); }
    template <class T>
    static T perRoot(const T& square) {
      T root = square;
      for (unsigned i = 0; i < sizeof(T) / sizeof(double); ++i) root[i] = std::sqrt(square[i]);
      return 1.0 / root;
    }
    double ring_, perTubeSquared_, ringClairaut_;
  };

 private:
  static double rho(const Eigen::Vector3d& x) { return std::sqrt(x[0] * x[0] + x[1] * x[1]); }
  double ring_, tube_;
};
static_assert(ImplicitSurface<TorusSurface>);

}  // namespace bio
