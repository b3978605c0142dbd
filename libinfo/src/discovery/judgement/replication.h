#pragma once

#include <optional>

#include "discovery/search/search.h"

// Not public.

namespace info::discover {

/// Searches the held-out trials alone for effects that the training trials showed: all nuisance
/// parameters are fitted anew, without the effects and with them. Empty if one of the effects is an
/// error of parameters or geometry, for which parameters that do not carry over are no support, or
/// if the model cannot be simulated.
/// @param entry  the effects as fitted to the training trials
std::optional<Replication> replicate(const DiscoveryProblem& data, const Options& options,
                                     const Whitening& sds, const Entry& entry,
                                     const Search::Report& report);

}  // namespace info::discover
