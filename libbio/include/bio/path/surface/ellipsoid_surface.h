#pragma once

#include "bio/path/surface/implicit_surface.h"

namespace bio {

/// Ellipsoid g = ½(x²/a² + y²/b² + z²/c² − 1), C∞. Its numbers: the semi-axes a, b, c [m] > 0.
class EllipsoidSurface {
 public:
  static constexpr int numNumbers = 3;

  /// @throws std::invalid_argument for a semi-axis that is not > 0
  explicit EllipsoidSurface(const Eigen::Vector3d& semiAxes);

  const Eigen::Vector3d& semiAxes() const { return semiAxes_; }
  double number(int i) const { return semiAxes_[i]; }
  double size() const { return size_; }
  double value(const Eigen::Vector3d& x) const { return 0.5 * (weighted(x).dot(x) - 1); }
  Eigen::Vector3d gradient(const Eigen::Vector3d& x) const { return weighted(x); }
  Eigen::Vector3d hessianTimes(const Eigen::Vector3d&, const Eigen::Vector3d& u) const {
    return weighted(u);
  }
  Eigen::Vector3d thirdTwice(const Eigen::Vector3d&, const Eigen::Vector3d&) const {
    return Eigen::Vector3d::Zero();
  }
  NumberDerivative ofNumber(const Eigen::Vector3d& x, int i) const {
    NumberDerivative d{-x[i] * x[i] * weights_[i] / semiAxes_[i], Eigen::Vector3d::Zero()};
    d.gradient[i] = -2 * x[i] * weights_[i] / semiAxes_[i];
    return d;
  }

  /// The geodesic equation without its velocity: along a geodesic Joachimsthal's
  /// J = (uᵀAu)(xᵀA²x) is constant, A = diag(1/a², 1/b², 1/c²), so that
  ///     x″ = −J/|Ax|⁴ Ax,   K = det A/|Ax|⁴
  class Flow {
   public:
    static constexpr double reach = 1.2;  ///< steps that extrapolation reaches in, found by trial
    Flow(const EllipsoidSurface& surface, const Eigen::Vector3d& x, const Eigen::Vector3d& u)
        : weights_(surface.weights_), determinant_(surface.weights_.prod()) {
      joachimsthal_ = surface.weighted(u).dot(u) * surface.weighted(x).squaredNorm();
    }
    /// Writes x″ and returns Gauss's curvature K. T: double, or several side by side.
    template <class T>
    T accelerate(const T* x, T* acceleration) const {
      const T gx = weights_[0] * x[0], gy = weights_[1] * x[1], gz = weights_[2] * x[2];
      const T square = gx * gx + gy * gy + gz * gz;
      const T perFourth = 1.0 / (square * square);
      const T pull = -joachimsthal_ * perFourth;
      acceleration[0] = pull * gx;
      acceleration[1] = pull * gy;
      acceleration[2] = pull * gz;
      return determinant_ * perFourth;
    }

   private:
    Eigen::Vector3d weights_;
    double determinant_, joachimsthal_;
  };

 private:
  Eigen::Vector3d weighted(const Eigen::Vector3d& x) const { return weights_.cwiseProduct(x); }
  Eigen::Vector3d semiAxes_, weights_;  // weights: 1/a²
  double size_;
};
static_assert(ImplicitSurface<EllipsoidSurface>);

}  // namespace bio
