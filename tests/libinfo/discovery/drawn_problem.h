#pragma once

#include "info/discovery/likelihood/joint_fit.h"
#include "support/linear_problem.h"

/// A linear problem with data drawn from it, and the noise they are drawn with.
namespace drawn_problem {

using namespace info::discover;
using Eigen::VectorXd;

inline const FitOptions kExact{30, 1e-10};
inline constexpr double kOutput = 0.02, kLatent = 0.7, kTime = 0.11;

inline LinearDisagreement drawn(int trials, int samples, double push, std::uint64_t seed = 3) {
  LinearDisagreement data(trials, samples);
  VectorXd truth = nominalValues(data);
  truth[0] = 1.15;
  truth[1] = push;
  data.draw(seed, truth, kOutput, kLatent, kTime);
  return data;
}

}  // namespace drawn_problem
