#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "info/discovery/discover.h"

namespace info::discover {

/// A model at one time step, and the options of its search.
struct Attempt {
  const DiscoveryProblem& data;
  Options options;
};

/// The verdict at a time step, and the options used.
struct SteppedVerdict {
  Verdict verdict;
  Options options;
  double step = 0;              ///< [s]
  double wallSeconds = 0;       ///< of the whole search
  double processorSeconds = 0;  ///< of the whole search, which has one thread
};

/// A clock that starts with its construction.
class SearchClock {
 public:
  SearchClock();
  /// Writes the wall time and this thread's processor time since the start.
  void writeTo(SteppedVerdict& found) const;

 private:
  std::chrono::steady_clock::time_point begin_;
  double processor_;  ///< of this thread [s]
};

/// Progress of a search that follows another: the last hundredth of the whole.
std::function<bool(const Progress&)> progressOfAnother(
    std::function<bool(const Progress&)> progress);

/// The error of too long a time step can look like a missing effect. Therefore run() is repeated at
/// half the step, continuing from the last result, while the finding is `numerical` or the model
/// cannot be simulated over the trials (std::domain_error), and the step is not below `shortest`.
/// If contacts begin and end at different times, errors do not vanish with the step: from the
/// second run on Options::numericalTolerance is doubled.
///
/// If the fitted trials show nothing although errors as large as those of the held-out trials are
/// improbable (Options::secondLook), the search is repeated with all trials fitted. An effect found
/// then is the verdict, with Verdict::heldOutFitted, and without a probability if the held-out
/// trials had made the first finding `unknown`; otherwise the sentence gives the probability of the
/// errors.
/// @param attempt returns the model at a step [s], with the same quantities and latent nodes at
///   each; valid until the next call
/// @param step [s] the first step
/// @param shortest  [s]; infinite: only the first step is taken
/// @throws what attempt and run() throw
SteppedVerdict runAtShorterSteps(const std::function<Attempt(double step)>& attempt, double step,
                                 double shortest);

/// A search over trials of which the last are held out.
struct TrialSearch {
  std::size_t numTrials = 0, numHeldOut = 0;
  std::optional<double> step;          ///< [s] the only one; empty: `firstStep`, halved if need be
  double firstStep = 0, shortest = 0;  ///< [s]
  Options options;                     ///< heldOut is set by searchTrials()
  bool onlyNominal = false;            ///< withoutSearch(), at the first step
};

/// Search, held-out test, second look and verdict, for any kind of system: runAtShorterSteps.
/// @param problemAt  the system with all trials at a step [s]; as `attempt` there
SteppedVerdict searchTrials(const TrialSearch& search,
                            const std::function<const DiscoveryProblem&(double step)>& problemAt);

}  // namespace info::discover
