#pragma once

// Not public.

#include <vector>

#include "bio/calibration/calibrate.h"
#include "info/estimation/estimate.h"

namespace bio {

/// Minima that the starts of a search found beside its estimate.
struct OtherMinima {
  info::Estimate best;               ///< the given estimate, or a better one
  std::vector<OtherMinimum> others;  ///< likely, or possible by the data; the likeliest first
  std::vector<Eigen::VectorXd> candidates;  ///< all ends, at most 20 nats above the best
  int iterations = 0, evaluations = 0;
};

/// Goes on from where other starts ended, with the noise that was estimated.
/// @param least   the cost, in nats
/// @param known   prior standard deviations of all numbers
/// @param common  so many of the first numbers are the model's, and tell minima apart
OtherMinima otherMinima(const info::LeastSquares& least,
                        const std::vector<info::StartOutcome>& starts,
                        const Eigen::VectorXd& priorSds, Eigen::Index common,
                        info::Estimate estimate, const info::EstimateOptions& options);

}  // namespace bio
