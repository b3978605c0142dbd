#pragma once

#include <optional>
#include <string>

#include "discovery/search/search.h"

// Not public.

namespace info::discover {

/// The candidate with this id.
std::optional<std::size_t> placeOf(const DiscoveryProblem& data, const std::string& id);

/// The results of a search about its chosen effects and their subsets, as the start of a search of
/// the same trials with another catalogue (DiscoveryProblem::withFormula); empty if that catalogue
/// lacks one of them.
std::optional<SearchMemory> searchMemoryOf(const Search& search, const Effects& chosen,
                                           const DiscoveryProblem& widened);

}  // namespace info::discover
