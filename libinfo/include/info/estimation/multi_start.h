#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "info/estimation/estimate.h"

namespace info {

struct MultiStartOptions {
  int starts = 1;  ///< number of starts ≥ 1; the first one is the start of the problem
  std::uint64_t seed = 1;
  int threads = 0;    ///< number of threads; 0: all cores
  double spread = 2;  ///< further starts lie within ± spread·scale of it; > 0
  EstimateOptions estimate =
      {};  ///< options of each start; the progress callback is called from all threads
  std::vector<Eigen::VectorXd> further = {};  ///< starts besides those
};

struct StartOutcome {
  Eigen::VectorXd start;
  Eigen::VectorXd parameters;  ///< where it ended
  double cost = 0;             ///< +∞ if the model is undefined at the start
  bool converged = false;
  std::string why;  ///< the reason for its end, in words
};

struct MultiStart {
  Estimate best;  ///< converged before not converged, then least cost; of those
                  ///< that agree the first
  std::vector<StartOutcome> outcomes;  ///< in the order of the starts
  /// Number of starts within 1e-3 nats of the best cost, the best one included.
  int agreeing = 0;
};

/// Estimates from several starts, which are given or drawn uniformly about the start of the
/// problem, within the bounds, from RandomStream(seed, start). The numbers do not depend on the
/// number of threads, and start i does not depend on the number of starts.
///
/// @param scale plausible error of each parameter, in its unit, ≥ 0
/// @throws std::invalid_argument if an option is out of range or sizes differ, and what estimate()
///   throws; std::domain_error of the first start if every start fails
MultiStart estimateFromStarts(const LeastSquares& problem, const Eigen::VectorXd& scale,
                              const MultiStartOptions& options = {});

}  // namespace info
