#pragma once

#include <Eigen/Dense>
#include <vector>

// Not public.

namespace bio::discover {

/// The speed that a recording shows where it begins: slope at the first sample of the least-squares
/// parabola through the samples of the first quarter of a second; 0 where that is no more than four
/// of its standard errors or less than 0.3 rad/s (m/s), as for trials that start at rest, or where
/// there are fewer than eight samples.
/// @param times  [s], rising
/// @param measured  as long as times [rad] or [m]
double initialSpeedShown(const std::vector<double>& times, const Eigen::VectorXd& measured);

}  // namespace bio::discover
