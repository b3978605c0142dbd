#pragma once

#include <cmath>
#include <optional>

#include "discovery/search/search.h"

// Not public.

namespace info::discover {

/// What a hypothesis, fitted to the training trials, makes of the trials that were held out.
struct HeldOutTrials {
  double score = -HUGE_VAL;  ///< log of their probability given the others
  double error = HUGE_VAL;   ///< of the simulation, with starts of their own [unit of the output]
  double meanSquare = HUGE_VAL;  ///< of their innovations given the others
  std::optional<Fit> starts;     ///< those of their own
};

/// @param all  likelihood of the training trials and those held out
/// @param held  likelihood of those held out
HeldOutTrials heldOutTrials(const DiscoveryProblem& data, const Search& search, const Entry& entry,
                            const Likelihood& all, const Likelihood& held);

}  // namespace info::discover
