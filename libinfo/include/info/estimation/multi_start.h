#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "info/estimation/estimate.h"

namespace info {

struct MultiStartOptions {
  int starts = 1;  ///< ≥ 1; the first one is the problem's own
  std::uint64_t seed = 1;
  int threads = 0;    ///< at most so many at once; 0: all cores
  double spread = 2;  ///< further starts lie within ± spread·scale of the own one; > 0
  EstimateOptions estimate =
      {};  ///< of each start; its progress callback is called from all threads
  std::vector<Eigen::VectorXd> further = {};  ///< starts besides those
};

struct StartOutcome {
  Eigen::VectorXd start;
  Eigen::VectorXd parameters;  ///< where it ended
  double cost = 0;             ///< +∞ if no prediction could be made at the start
  bool converged = false;
  std::string why;  ///< it ended, in words
};

struct MultiStart {
  Estimate best;  ///< converged before not converged, then least cost; of those
                  ///< that agree the first
  std::vector<StartOutcome> outcomes;  ///< in the order of the starts
  /// Starts that ended at the best cost to within 1e-3 nats; the best one included.
  int agreeing = 0;
};

/// Estimates from several starts, drawn uniformly about the problem's own within the bounds from
/// RandomStream(seed, start), and from those that are given: the same numbers whatever the number
/// of threads, and start i the same whatever the number of starts.
///
/// @param scale what a parameter may well be off by, in its unit, ≥ 0
/// @throws std::invalid_argument if an option is out of range or sizes differ, and what estimate()
///   throws; std::domain_error of the first start if no start can be estimated from
MultiStart estimateFromStarts(const LeastSquares& problem, const Eigen::VectorXd& scale,
                              const MultiStartOptions& options = {});

}  // namespace info
