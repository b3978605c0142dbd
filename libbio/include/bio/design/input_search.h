#pragma once

#include <Eigen/Dense>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <vector>

#include "bio/design/design_inputs.h"

namespace bio {

struct DesignSearchSettings {
  int candidates = 100;   ///< random initial designs ≥ 0
  int generations = 100;  ///< of the evolution strategy from the best of them ≥ 0
  int iterations = 10;    ///< of the final gradient search ≥ 0, where there is one
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Called with the fraction done, from any thread, one call at a time; returning false stops the
  /// search and keeps the best.
  std::function<bool(double)> progress = {};
};

/// How a search went.
struct DesignSearchRecord {
  bool improved = false;      ///< something better than the trial itself respects the limits
  bool stopped = false;       ///< stopped by the callback
  int runs = 0;               ///< experiments that were simulated
  int impossible = 0;         ///< those that did not reach the end
  std::vector<double> costs;  ///< of each new best experiment that respects the limits
  std::vector<int> foundAt;   ///< run at which it was found
};

/// The search for inputs that all designs share: random inputs about the trial's own, then
/// info::evolve() from the best. Keeps the best that respects every limit.
class InputSearch {
 public:
  static constexpr double worthless = std::numeric_limits<double>::infinity();

  /// @param best     cost of the trial itself, which has to be undercut
  /// @param further  runs after evolve(), for the progress
  /// @param record   is filled in
  /// @throws std::invalid_argument for numbers < 0
  InputSearch(const DesignInputs& inputs, const DesignSearchSettings& settings, double best,
              double further, DesignSearchRecord& record);

  /// Takes note of a run; may be called from several threads.
  /// @param cost  of an experiment that respects every limit; else infinite
  void note(const Eigen::VectorXd& x, bool isPossible, double cost);
  bool isStopped() const { return stop_; }
  /// The best inputs.
  /// @param costOf  the cost with a price for limits that are not respected; calls note() unless
  ///   the search is stopped
  Eigen::VectorXd evolve(const std::function<double(const Eigen::VectorXd&)>& costOf) const;
  /// Values of the best run that was noted; empty if none undercuts the trial itself.
  const Eigen::VectorXd& bestInputs() const { return bestInputs_; }

 private:
  const DesignInputs& inputs_;
  const DesignSearchSettings& settings_;
  double best_, planned_;
  DesignSearchRecord& record_;
  Eigen::VectorXd bestInputs_;
  std::mutex mutex_;
  std::atomic<bool> stop_{false};
};

/// From the first time on, `period` apart.
/// @throws std::invalid_argument for a period that is not a millionth of the duration to all of it
std::vector<double> samplingTimes(double start, double duration, double period);

}  // namespace bio
