#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info::discover {

/// How far a force is the same function of time in every trial.
struct TimeTie {
  /// Share of the force's power that its mean over the trials has, 0 to 1; about 1/N for N trials
  /// that have nothing in common. 0 for fewer than two trials.
  double share = 0;
  double stepAt = 0;             ///< [s] the time that parts the mean best into two levels
  double stepShare = 0;          ///< share of the mean's variance between those levels
  double before = 0, after = 0;  ///< the levels
};

/// Over the time that all trials have in common; straight lines between the nodes.
/// @param times  [s] of each trial's nodes, strictly rising
/// @param forces at these
TimeTie timeTie(const std::vector<std::vector<double>>& times,
                const std::vector<Eigen::VectorXd>& forces);

}  // namespace info::discover
