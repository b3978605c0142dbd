#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "info/estimation/estimate.h"

namespace info {

struct BootstrapOptions {
  int replicates = 200;  ///< ≥ 2
  std::uint64_t seed = 1;
  int threads = 0;                ///< at most so many at once; 0: all cores
  Eigen::Index blockLength = 1;   ///< samples that stay together, ≥ 1
  EstimateOptions estimate = {};  ///< of each replicate; its confidence is that of the intervals
  /// Called with the number of replicates done, from any thread, one call at a time; returning
  /// false stops before those not yet begun.
  std::function<bool(int done, int replicates)> progress = {};
};

struct BootstrapResult {
  Eigen::MatrixXd parameters;  ///< parameters × converged replicates
  Eigen::VectorXd sd;          ///< standard deviation over them
  Eigen::MatrixX2d intervals;  ///< from quantile to quantile
  int converged = 0;
  bool complete = true;  ///< false if the callback stopped it
};

/// Repeats an estimation on data made anew: the prediction at the estimate plus its own residuals,
/// centred, enlarged by √(n/(n − p)), and drawn with replacement in blocks, so that noise that is
/// correlated over less than a block keeps its correlation. Prior means are drawn anew as well, so
/// that the spread is that of the posterior and not of the data alone.
///
/// Blocks run around the end of a series to its start. Replicate i draws from
/// RandomStream(seed, i). Sources: Künsch 1989; Davison & Hinkley 1997, ch. 6 and 8.
///
/// @param estimated the minimum of `problem`
/// @param series    lengths of the series that the samples are made of, in order; empty: one
/// @throws std::invalid_argument if an option is out of range, the lengths do not add up, or some
///   sample was not observed
BootstrapResult bootstrap(const LeastSquares& problem, const Estimate& estimated,
                          std::vector<Eigen::Index> series, const BootstrapOptions& options = {});

}  // namespace info
