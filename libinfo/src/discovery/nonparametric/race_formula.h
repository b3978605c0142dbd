#pragma once

#include "discovery/search/search.h"
#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// Adds the formula of an unknown effect to the model and compares it: run() on the same data with
/// only the formula and the effects in `kept` as candidates, starting from the results of a search
/// about these. Empty if a term is not a function of the state, if the problem does not offer
/// formulas, or if the search was stopped.
/// @param options of that run; `symbolic` is taken as false
std::optional<RacedFormula> raceFormula(const Search& search, const Unknown& unknown,
                                        const Effects& kept, Options options);

}  // namespace info::discover
