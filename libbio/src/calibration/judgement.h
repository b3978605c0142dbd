#pragma once

// Not public.

#include <vector>

#include "calibration/asked_parameters.h"

namespace bio {

/// Estimates with their uncertainty.
struct Judgement {
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of all estimates; 0 for a parameter at a bound
  Eigen::MatrixXd covariance;   ///< likewise
};

/// @param estimate   θ
/// @param data       Fisher information of the data in all numbers at θ; without priors
/// @param confidence of the intervals, in (0, 1)
Judgement judged(const AskedParameters& asked, const TrialSet& training,
                 const Eigen::VectorXd& estimate, const Eigen::MatrixXd& data, double confidence);

}  // namespace bio
