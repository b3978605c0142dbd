#pragma once

#include <Eigen/Core>
#include <vector>

namespace hidden {

/// An interpolating cubic spline as OpenSim's SimmSpline defines it, made here from the slopes at
/// the knots (libbio makes its own from second derivatives).
///
/// Unknown slopes m_i: the second derivative is continuous inside, and on the first and last
/// interval the third derivative is that of the cubic through the four end points (Forsythe,
/// Malcolm, Moler). A doubled point counts as two that are 1e-7 apart. Straight beyond the ends.
class ForceCurve {
 public:
  ForceCurve() = default;
  /// @throws std::invalid_argument for fewer than 4 points or x that falls
  ForceCurve(std::vector<double> x, std::vector<double> y);

  double at(double x) const;

 private:
  std::vector<double> x_, y_;
  Eigen::VectorXd slope_;
};

}  // namespace hidden
