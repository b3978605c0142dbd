#pragma once

#include <vector>

#include "info/estimation/estimate.h"

namespace info {

/// A point of a profile: one parameter fixed, all others optimal.
struct ProfilePoint {
  double value;                ///< of the fixed parameter
  double cost;                 ///< minimal β over the other parameters; +∞: the model has no value
  Eigen::VectorXd parameters;  ///< where it is attained
  bool converged;
};

struct Profile {
  std::vector<ProfilePoint> points;  ///< in the order of the requested values
  double threshold;  ///< β at the estimate + z²/2: values below it are in the confidence region
};

/// The profile likelihood of a parameter: the minimal cost as a function of its fixed value. Unlike
/// the Cramér–Rao interval it does not assume that β is a parabola; if the profile stays below the
/// threshold on one side, the data do not bound the parameter there.
///
/// Each point starts from its neighbour's parameters, outwards from the estimate; where the model
/// has no value there, the point's cost is infinite. Source: Raue et al. 2009; threshold from the likelihood-ratio test with one degree of freedom.
///
/// @param estimated the minimum of `problem`
/// @param values within the parameter's bounds
/// @throws std::invalid_argument if index or a value is out of range
Profile profileLikelihood(const LeastSquares& problem, const Estimate& estimated,
                          Eigen::Index parameter, const std::vector<double>& values,
                          const EstimateOptions& options = {});

/// The values of a parameter at which its profile crosses the threshold: a confidence interval, not
/// necessarily symmetric.
struct ProfileInterval {
  Profile profile;
  double lower;  ///< −∞ if the profile stays below the threshold down to the lowest value tried
  double upper;  ///< +∞ likewise
  bool lowerAtBound = false;  ///< the parameter's bound lies within the confidence region
  bool upperAtBound = false;
};

/// Searches outwards from the estimate: profile points at 1, 2, 4 and 8 times z·deviation on each
/// side, until one is beyond the threshold; the crossing is found by regula falsi on the signed
/// root √(2(β − β̂)), nearly straight in the parameter, to 1 % of the deviation; by halving where
/// the model ends before the threshold is reached: the interval then ends there.
///
/// @param deviation Cramér–Rao standard deviation of the parameter [its unit] > 0, finite
/// @throws std::invalid_argument for any other deviation, and what profileLikelihood throws
ProfileInterval profileInterval(const LeastSquares& problem, const Estimate& estimated,
                                Eigen::Index parameter, double sd,
                                const EstimateOptions& options = {});

}  // namespace info
