#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/calibration/trial_set.h"
#include "calibration/channel_noise.h"
#include "info/estimation/estimate.h"

namespace bio {

/// Where estimates end that are led from each start by models held near the measured coordinates,
/// less and less firmly (nudge.h): starts for the estimate itself. Those that cannot be simulated
/// are left out; none if no coordinate can be held.
/// @param channels    weighs all that was measured
/// @param parameters  with bounds and priors
/// @param starts      θ each
/// @param sd          of the weighted measurements > 0
std::vector<Eigen::VectorXd> nudgedStarts(const TrialSet& trials, const ChannelNoise& channels,
                                          const std::vector<info::Parameter>& parameters,
                                          const std::vector<Eigen::VectorXd>& starts, double sd,
                                          const info::EstimateOptions& estimate);

/// The start, and for every parameter that shapes a path – a radius of a wrap object, a path point
/// – one on either side of it: lengths depend on these in ways that have more than one valley.
std::vector<Eigen::VectorXd> startsOnBothSides(const TrialSet& trials,
                                               const std::vector<info::Parameter>& parameters,
                                               const Eigen::VectorXd& start);

/// Standard deviation of a channel's noise, in its unit, from third differences; 0 where no four
/// samples of a series are equally spaced.
double measuredSd(const TrialSet& trials, std::size_t channel);

}  // namespace bio
