#pragma once

#include <optional>
#include <string>

#include "discovery/search/search.h"

// Not public.

namespace info::discover {

/// The candidate with this id.
std::optional<std::size_t> placeOf(const DiscoveryProblem& data, const std::string& id);

/// What a search knows of the effects that it has chosen and of parts of them, for a search of the
/// same trials with another catalogue (DiscoveryProblem::withFormula); nothing if that lacks one of
/// them.
std::optional<SearchMemory> searchMemoryOf(const Search& search, const Effects& chosen,
                                           const DiscoveryProblem& widened);

}  // namespace info::discover
