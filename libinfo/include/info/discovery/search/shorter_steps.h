#pragma once

#include <functional>

#include "info/discovery/discover.h"

namespace info::discover {

/// A model at one time step, and what the engine is told.
struct Attempt {
  const DiscoveryProblem& data;
  Options options;
};

/// What was found at a step, and with which options.
struct SteppedVerdict {
  Verdict verdict;
  Options options;
  double step = 0;  ///< [s]
};

/// Steps that are too long look like an effect: run() again at half the step, from where it has
/// ended, while the finding is `numerical`, or the model cannot be simulated over the trials at all
/// (std::domain_error), and the step is not below `shortest`. Where paths touch and lift off at
/// different times errors do not vanish with the step: from the second on
/// Options::numericalTolerance counts twice.
///
/// Where nothing was found and errors as large as those of the held-out trials are improbable
/// (Options::secondLook), all trials are fitted and all is asked once more: a name that is found
/// then is the answer, with Verdict::heldOutFitted; else the sentence says how improbable.
/// @param attempt   makes the model at a step [s], with the same quantities and latent nodes at
///   each; it lives until the next call
/// @param step      [s] the first
/// @param shortest  [s]; infinite: only the first step is taken
/// @throws what attempt and run() throw
SteppedVerdict runAtShorterSteps(const std::function<Attempt(double step)>& attempt, double step,
                                 double shortest);

}  // namespace info::discover
