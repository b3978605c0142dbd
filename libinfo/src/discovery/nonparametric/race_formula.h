#pragma once

#include "discovery/search/search.h"
#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// Puts the formula of what has no name into the model and races it: run() on the same data with
/// the formula and the effects in `kept` alone, from what a search knows of these. Nothing if a
/// term does not follow the state, if the data do not offer it, or if the work was stopped.
/// @param options  of that race; `symbolic` is taken as false
std::optional<RacedFormula> raceFormula(const Search& search, const Unknown& unknown,
                                        const Effects& kept, Options options);

}  // namespace info::discover
