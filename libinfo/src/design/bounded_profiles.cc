#include "info/design/bounded_profiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "info/dynamics/linear_table.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

BoundedProfiles::BoundedProfiles(std::vector<double> knots, std::vector<ProfileLimits> inputs)
    : knots_(std::move(knots)), inputs_(std::move(inputs)) {
  if (knots_.size() < 2) {
    throw std::invalid_argument(fmt::format("{} knots, must be at least 2", knots_.size()));
  }
  for (std::size_t k = 1; k < knots_.size(); ++k) {
    if (!(knots_[k] > knots_[k - 1]) || !std::isfinite(knots_[k])) {
      throw std::invalid_argument(
          fmt::format("knot at {} s after {} s, must rise", knots_[k], knots_[k - 1]));
    }
  }
  for (const ProfileLimits& input : inputs_) {
    if (!(input.lower < input.upper) || !std::isfinite(input.lower) ||
        !std::isfinite(input.upper)) {
      throw std::invalid_argument(fmt::format(
          "limits of an input = {} to {}, must be finite and rise", input.lower, input.upper));
    }
    if (!(input.rate > 0)) {
      throw std::invalid_argument(
          fmt::format("largest rate of an input = {} 1/s, must be > 0", input.rate));
    }
    if (input.first && !(*input.first >= input.lower && *input.first <= input.upper)) {
      throw std::invalid_argument(fmt::format("first value of an input = {}, must be {} to {}",
                                              *input.first, input.lower, input.upper));
    }
  }
}

Index BoundedProfiles::size() const {
  return numKnots() * static_cast<Index>(inputs_.size());
}

double BoundedProfiles::largestStep(std::size_t input, Index knot) const {
  const ProfileLimits& limits = inputs_[input];
  const auto k = static_cast<std::size_t>(knot);
  return limits.rate * (knots_[k + 1] - knots_[k]) * 2 / (limits.upper - limits.lower);
}

double BoundedProfiles::firstOf(std::size_t input) const {
  const ProfileLimits& limits = inputs_[input];
  return (2 * *limits.first - limits.lower - limits.upper) / (limits.upper - limits.lower);
}

VectorXd BoundedProfiles::project(const VectorXd& x) const {
  const Index n = numKnots();
  VectorXd result(x.size());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    VectorXd z = x.segment(static_cast<Index>(i) * n, n);
    const bool held = inputs_[i].first.has_value();
    // box, steps from even knots, steps from odd knots: each projected on in turn, each with what
    // it took away the last time given back
    MatrixXd taken = MatrixXd::Zero(n, 3);
    for (int sweep = 0; sweep < 2000; ++sweep) {
      const VectorXd before = z;
      VectorXd y = z + taken.col(0);
      z = y.cwiseMax(-1.0).cwiseMin(1.0);
      if (held) z[0] = firstOf(i);
      taken.col(0) = y - z;
      for (Index parity = 0; parity < 2; ++parity) {
        y = z + taken.col(1 + parity);
        z = y;
        for (Index k = parity; k + 1 < n; k += 2) {
          const double step = z[k + 1] - z[k];
          const double excess = std::abs(step) - largestStep(i, k);
          if (excess <= 0) continue;
          z[k] += std::copysign(excess / 2, step);
          z[k + 1] -= std::copysign(excess / 2, step);
        }
        taken.col(1 + parity) = y - z;
      }
      if (sweep > 0 && (z - before).cwiseAbs().maxCoeff() < 1e-10) break;
    }
    // clip remaining violations
    z = z.cwiseMax(-1.0).cwiseMin(1.0);
    if (held) z[0] = firstOf(i);
    for (Index k = 0; k + 1 < n; ++k) {
      const double step = largestStep(i, k);
      z[k + 1] = std::clamp(z[k + 1], z[k] - step, z[k] + step);
    }
    result.segment(static_cast<Index>(i) * n, n) = z;
  }
  return result;
}

double BoundedProfiles::excess(const VectorXd& x) const {
  double largest = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const auto z = x.segment(static_cast<Index>(i) * numKnots(), numKnots());
    largest = std::max(largest, z.cwiseAbs().maxCoeff() - 1);
    if (inputs_[i].first) largest = std::max(largest, std::abs(z[0] - firstOf(i)));
    for (Index k = 0; k + 1 < numKnots(); ++k) {
      largest = std::max(largest, std::abs(z[k + 1] - z[k]) - largestStep(i, k));
    }
  }
  return largest;
}

MatrixXd BoundedProfiles::values(const VectorXd& x, const std::vector<double>& times) const {
  MatrixXd result(static_cast<Index>(times.size()), static_cast<Index>(inputs_.size()));
  for (std::size_t t = 0; t < times.size(); ++t) {
    const LinearWeights place = linearAt(knots_, times[t]);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const ProfileLimits& limits = inputs_[i];
      const auto z = x.segment(static_cast<Index>(i) * numKnots(), numKnots());
      const double at = place.value(z);
      result(static_cast<Index>(t), static_cast<Index>(i)) =
          std::clamp((limits.lower + limits.upper) / 2 + at * (limits.upper - limits.lower) / 2,
                     limits.lower, limits.upper);
    }
  }
  return result;
}

VectorXd BoundedProfiles::coefficients(const MatrixXd& atKnots) const {
  VectorXd x(size());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const ProfileLimits& limits = inputs_[i];
    const auto column = static_cast<Index>(i);
    x.segment(column * numKnots(), numKnots()) =
        (2 * atKnots.col(column).array() - limits.lower - limits.upper) /
        (limits.upper - limits.lower);
  }
  return x;
}

}  // namespace info
