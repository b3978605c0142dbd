#pragma once

// Not public.

#include <vector>

#include "bio/calibration/calibrate.h"
#include "info/estimation/estimate.h"

namespace bio {

/// All numbers of held-out trials: the given ones, and the start of each trial, estimated from it
/// with those fixed, if the set has own starts.
/// @param common   the parameters of the model
/// @param training the trials that these come from, whose channels have these noises
Eigen::VectorXd valuesOfHeldOut(const TrialSet& heldOut, const Eigen::VectorXd& common,
                                const TrialSet& training, const std::vector<ResidualNoise>& noises,
                                const CalibrationOptions& options,
                                const info::EstimateOptions& estimate);

/// √diag(Γ Σ Γᵀ) of their samples at all values of theirs.
/// @param covariance  Σ of the common parameters
Eigen::VectorXd predictionSd(const TrialSet& heldOut, const Eigen::VectorXd& values,
                             const Eigen::MatrixXd& covariance);

}  // namespace bio
