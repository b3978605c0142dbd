#pragma once

// Not public.

#include <vector>

#include "bio/calibration/calibrate.h"
#include "info/estimation/estimate.h"

namespace bio {

/// Goes on from an end of an interval of the first `common` numbers where the cost is lower than at
/// the estimate: the search has stopped early there, as it may at a corner of the cost.
/// @return with iterations and evaluations added up; the estimate itself where no end is lower, or
/// no
///   search from there converges as it did
info::Estimate betterBeside(const info::LeastSquares& least, info::Estimate estimate,
                            Eigen::Index common, const info::EstimateOptions& options);

/// Compares the cost at the ends of the intervals of the first `common` parameters with what the
/// Fisher matrix claims of it, and takes the profile likelihood's interval, or none, where they
/// differ (calibrate.h).
/// @param covariance  at the estimate, of all numbers
void checkIntervals(const info::LeastSquares& least, const info::Estimate& estimate,
                    const Eigen::MatrixXd& covariance, Eigen::Index common,
                    const info::EstimateOptions& options,
                    std::vector<CalibratedParameter>& parameters);

/// Widens the intervals so that they enclose the other minima.
void encloseMinima(const std::vector<OtherMinimum>& minima, Eigen::Index common, double confidence,
                   std::vector<CalibratedParameter>& parameters);

}  // namespace bio
