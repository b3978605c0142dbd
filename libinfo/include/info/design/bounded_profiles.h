#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

namespace info {

/// The limits of an input.
struct ProfileLimits {
  double lower, upper;               ///< [unit of u], lower < upper
  double rate;                       ///< |du/dt| ≤ rate [unit/s] > 0, may be infinite
  std::optional<double> first = {};  ///< fixed value at the first knot
};

/// Piecewise linear inputs u(t), and the projection onto those that respect their limits.
///
/// The coefficients x of an input are its values at the knots, scaled so that its limits are ±1:
///     u(t_k) = (lower + upper)/2 + x_k·(upper − lower)/2
/// A linear piece respects the limits if its ends do, so limits and rates hold at all times if
/// |x_k| ≤ 1, |x_{k+1} − x_k| ≤ rate·(t_{k+1} − t_k)·2/(upper − lower). The inputs follow each
/// other in x.
class BoundedProfiles {
 public:
  /// @param knots [s] strictly rising, at least 2
  /// @throws std::invalid_argument if the knots do not rise, limits are not lower < upper, a rate
  ///   is not > 0, or a held first value is outside its limits
  BoundedProfiles(std::vector<double> knots, std::vector<ProfileLimits> inputs);

  const std::vector<double>& knots() const { return knots_; }
  const std::vector<ProfileLimits>& inputs() const { return inputs_; }
  /// Number of coefficients: inputs × knots.
  Eigen::Index size() const;

  /// The projection of x onto the convex set of coefficients that respect all limits (Dykstra's
  /// alternating projections, to 1e-9; remaining violations are then clipped from front to back).
  Eigen::VectorXd project(const Eigen::VectorXd& x) const;

  /// Violation of the limits by x, in units of x; 0 if there is none.
  double excess(const Eigen::VectorXd& x) const;

  /// Values at times, held constant outside the knots: times × inputs.
  Eigen::MatrixXd values(const Eigen::VectorXd& x, const std::vector<double>& times) const;

  /// x of inputs given by their values at the knots (knots × inputs); not projected.
  Eigen::VectorXd coefficients(const Eigen::MatrixXd& atKnots) const;

 private:
  Eigen::Index numKnots() const { return static_cast<Eigen::Index>(knots_.size()); }
  double largestStep(std::size_t input,
                     Eigen::Index knot) const;  ///< largest difference of x to the next knot
  double firstOf(std::size_t input) const;

  std::vector<double> knots_;
  std::vector<ProfileLimits> inputs_;
};

}  // namespace info
