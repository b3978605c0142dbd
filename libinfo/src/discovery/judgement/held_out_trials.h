#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "discovery/search/search.h"

// Not public.

namespace info::discover {

/// The trials that are not held out.
std::vector<int> fittedTrials(const DiscoveryProblem& data, const Options& options);

/// The held-out trials under a hypothesis that was fitted to the training trials.
struct HeldOutTrials {
  double score = -HUGE_VAL;      ///< log probability given the training trials
  double error = HUGE_VAL;       ///< of the simulation, initial states fitted [unit of the output]
  double meanSquare = HUGE_VAL;  ///< of the innovations given the training trials
  std::optional<Fit> starts;     ///< fitted initial states
};

/// @param all  likelihood of the training and held-out trials
/// @param held  likelihood of the held-out trials
HeldOutTrials heldOutTrials(const DiscoveryProblem& data, const Search& search, const Entry& entry,
                            const Likelihood& all, const Likelihood& held);

}  // namespace info::discover
