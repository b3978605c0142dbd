#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <vector>

namespace info {

struct EvolutionOptions {
  int generations = 100;
  int population = 0;   ///< points per generation; 0: 4 + ⌊3 ln n⌋, at least 8
  double spread = 0.3;  ///< initial standard deviation of every coordinate [unit of x] > 0
  std::uint64_t seed = 1;
  int threads = 0;  ///< number of concurrent cost evaluations; 0: all cores
  /// Called after every generation; returning false stops.
  std::function<bool(int generation, double best)> progress = {};
};

struct EvolutionResult {
  Eigen::VectorXd x;          ///< the best point found, in the set
  double cost = 0;            ///< there
  std::vector<double> costs;  ///< best cost after each generation
  int evaluations = 0;
  bool stopped = false;
};

/// Minimises a cost over a convex set by covariance matrix adaptation (CMA-ES with weighted
/// recombination, cumulation and rank-μ update; Hansen, "The CMA Evolution Strategy: A Tutorial",
/// 2016, with its default weights and rates).
///
/// For costs with many kinks and local minima, for which gradients are useless: only ranks are
/// used. A point outside the set is evaluated at its projection and penalised by its squared
/// distance. A cost that is not finite ranks last. The same seed gives the same points for any
/// number of threads.
///
/// @param cost    pure; called from several threads
/// @param project projection onto the set
/// @throws std::invalid_argument if an option is out of range or start is empty
EvolutionResult evolve(const std::function<double(const Eigen::VectorXd&)>& cost,
                       const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& project,
                       const Eigen::VectorXd& start, const EvolutionOptions& options = {});

}  // namespace info
