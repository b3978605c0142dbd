#pragma once

// Not public.

#include <vector>

#include "bio/calibration/trial_set.h"

namespace bio {

/// Starts with one path point elsewhere, where the muscle's lengths over the measured postures are
/// nearest to those of an estimate: an insertion mirrored at its joint may fit as well, and no
/// search that begins beside the estimate ends there. A point without such a place has no start.
///
/// The place is the lowest minimum of the RMS difference of lengths over the parameter's bounds,
/// the one at the estimate excluded, if it is below 5 mm. At most six points are looked at.
/// @param parameters  bounds of all estimated numbers
/// @param estimate    of all estimated numbers
std::vector<Eigen::VectorXd> startsAtLikePaths(const TrialSet& trials,
                                               const std::vector<info::Parameter>& parameters,
                                               const Eigen::VectorXd& estimate);

}  // namespace bio
