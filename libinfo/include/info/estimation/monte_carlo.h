#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "info/estimation/estimate.h"
#include "info/probability/random_stream.h"

namespace info {

struct MonteCarloOptions {
  int trials = 300;
  std::uint64_t seed = 1;
  int threads = 0;  ///< number of threads; 0: all cores
  double startSpread =
      0;  ///< each trial starts uniformly within truth·(1 ± startSpread), in the bounds; ≥ 0
  EstimateOptions
      estimate;  ///< options of every trial; the progress callback is called from all threads
  /// Called with the number of finished trials, from any thread, one call at a time; returning
  /// false skips the trials that have not begun.
  std::function<bool(int done, int trials)> progress = {};
};

struct MonteCarloTrial {
  Eigen::VectorXd start;
  Eigen::VectorXd parameters;  ///< final estimate
  double cost = 0;
  Termination why = Termination::stopped;
  bool converged = false;
  int iterations = 0;
};

struct MonteCarloResult {
  std::vector<MonteCarloTrial> trials;  ///< in order, without those skipped after a stop
  int converged = 0;
  Eigen::VectorXd mean;  ///< of the converged trials' estimates
  Eigen::MatrixXd
      covariance;  ///< sample covariance of these (divided by n − 1); NaN for fewer than two
  Eigen::MatrixXd bound;  ///< Cramér–Rao bound at the truth (priors not included)
  bool complete = true;   ///< false if stopped by the callback
};

/// Monte Carlo study of an estimator: simulates an experiment many times and estimates each time,
/// to compare the estimates with the Cramér–Rao bound. Trial i adds noise ~ N(0, Σ_k) to y(θ) and
/// draws its start from RandomStream(seed, i), so that every number is bitwise independent of the
/// number of threads, and trial i of the number of trials.
///
/// @param predictor must be pure; it is used from several threads
/// @param truth θ of the simulated data; the parameters' own start values are not used
/// @param observed as in Measurements
/// @throws std::invalid_argument if an option is out of range or the truth violates a bound, and
///   what
///         estimate() and cramerRaoBound() throw
MonteCarloResult monteCarlo(const Predictor& predictor, const Eigen::VectorXd& truth,
                            const OutputCovariance& covariance,
                            const std::vector<Parameter>& parameters,
                            const MonteCarloOptions& options = {},
                            const ObservationMask& observed = {});

/// Noise ~ N(0, Σ) on n samples: outputs × n. Drawn in the order of the samples.
Eigen::MatrixXd drawNoise(const OutputCovariance& covariance, Eigen::Index n, RandomStream& random);

}  // namespace info
