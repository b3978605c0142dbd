#pragma once

#include <Eigen/Dense>
#include <array>

#include "reduced/reduced_elbow.h"
#include "reduced/reduced_quantities.h"

namespace reduced {

/// q̈ and its derivatives at one instant.
struct Instant {
  double acceleration, byQ, bySpeed, scale, inertia;
  std::array<double, kMuscles> byLevel, byUsed;
  std::array<double, kShared> direct;
};

/// @param level  activations, @param used  their integrals, @param latent  a further torque [N·m]
template <bool derivatives>
void evaluate(const Eigen::VectorXd& values, double q, double w,
              const std::array<double, kMuscles>& level, const std::array<double, kMuscles>& used,
              double latent, Instant& now);

}  // namespace reduced
