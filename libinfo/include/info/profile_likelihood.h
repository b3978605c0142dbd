#pragma once

#include <vector>

#include "info/estimate.h"

namespace info {

/// One parameter held, all others at their best.
struct ProfilePoint {
  double value;                ///< of the parameter held
  double cost;                 ///< least β over the other parameters
  Eigen::VectorXd parameters;  ///< where it is attained
  bool converged;
};

struct Profile {
  std::vector<ProfilePoint> points;  ///< in the order of the values asked for
  double threshold;  ///< β at the estimate + z²/2: values below it are in the confidence region
};

/// The profile likelihood of a parameter: how much worse the best fit becomes as the parameter is
/// held at other values. Unlike the Cramér–Rao interval it does not suppose that β is a parabola; a
/// profile that stays below the threshold on one side says that the data do not bound the parameter
/// there.
///
/// Each point starts from its neighbour's parameters, outwards from the estimate. Source: Raue et
/// al. 2009; threshold from the likelihood-ratio test with one degree of freedom.
///
/// @param estimated the minimum of `problem`
/// @param values within the parameter's bounds
/// @throws std::invalid_argument if index or a value is out of range
Profile profileLikelihood(const LeastSquares& problem, const Estimate& estimated,
                          Eigen::Index parameter, const std::vector<double>& values,
                          const EstimateOptions& options = {});

}  // namespace info
