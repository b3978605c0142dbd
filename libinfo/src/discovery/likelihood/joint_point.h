#pragma once

#include <Eigen/Dense>
#include <vector>

#include "discovery/likelihood/damped_system.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// A point of the joint minimisation over (ξ, η).
struct Likelihood::Point {
  Eigen::VectorXd values, xi;
  std::vector<Eigen::VectorXd> eta;
};

/// The normal equations over (ξ, η) at a point.
struct Likelihood::Normal {
  DampedSystem::Blocks blocks;
  JointVector downhill;  ///< −dJ/d(ξ, η)
};

/// A step from one point to another.
struct Likelihood::Step {
  Point to;
  double gain = 0;                   ///< gain predicted by the linear model [nats]
  JointVector move;                  ///< first-order step
  std::vector<Eigen::Index> moving;  ///< ξ not blocked by a bound
};

}  // namespace info::discover
