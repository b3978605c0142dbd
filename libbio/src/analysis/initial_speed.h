#pragma once

#include <Eigen/Dense>
#include <vector>

// Not public.

namespace bio {

/// The speed that a recording shows where it begins: slope at the first sample of the least-squares
/// parabola through the samples of the first quarter of a second; 0 where that is no more than four
/// of its standard errors or less than `slowest`, as for trials that start at rest, or where there
/// are fewer than eight samples.
/// @param times  [s], rising
/// @param measured  as long as times [rad] or [m]
/// @param slowest  0.3 rad/s, of a shift 0.0375 m/s
double initialSpeedShown(const std::vector<double>& times, const Eigen::VectorXd& measured,
                         double slowest = 0.3);

}  // namespace bio
