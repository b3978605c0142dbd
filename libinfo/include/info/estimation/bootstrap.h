#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "info/estimation/estimate.h"

namespace info {

struct BootstrapOptions {
  int replicates = 200;  ///< ≥ 2
  std::uint64_t seed = 1;
  int threads = 0;               ///< number of threads; 0: all cores
  Eigen::Index blockLength = 1;  ///< length of the resampled blocks, ≥ 1
  EstimateOptions estimate =
      {};  ///< options of each replicate; its confidence also applies to the intervals
  /// Called with the number of finished replicates, from any thread, one call at a time; returning
  /// false skips the replicates that have not begun.
  std::function<bool(int done, int replicates)> progress = {};
};

struct BootstrapResult {
  Eigen::MatrixXd parameters;  ///< parameters × converged replicates
  Eigen::VectorXd sd;          ///< standard deviation of these
  Eigen::MatrixX2d intervals;  ///< from quantile to quantile
  int converged = 0;
  bool complete = true;  ///< false if stopped by the callback
};

/// Residual bootstrap: repeats an estimation on synthetic data, which are the prediction at the
/// estimate plus its residuals, centred, scaled by √(n/(n − p)), and drawn with replacement in
/// blocks, so that correlations of the noise within a block are kept. Prior means are drawn as
/// well, so that the spread is that of the posterior and not only of the data.
///
/// Blocks wrap around from the end of a series to its start. Replicate i draws from
/// RandomStream(seed, i). Sources: Künsch 1989; Davison & Hinkley 1997, ch. 6 and 8.
///
/// @param estimated the minimum of `problem`
/// @param series lengths of the consecutive series of samples; empty: one series
/// @throws std::invalid_argument if an option is out of range, the lengths do not add up, or a
///   sample was not observed
BootstrapResult bootstrap(const LeastSquares& problem, const Estimate& estimated,
                          std::vector<Eigen::Index> series, const BootstrapOptions& options = {});

}  // namespace info
