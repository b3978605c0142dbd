#pragma once

#include "discovery/search/search.h"
#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// Races forces without a name, each a smooth function of the angle or of the speed alone, against
/// the names that a search has chosen, or against none
/// (docs/decisions/047-nonparametric-forces.md). The better one of them; nothing if the data do
/// not offer formulas, or if neither could be fitted.
/// @param smoothing  the base model with latent force: where the arm really goes
/// @param fits  grows by how many there were
std::optional<NonparametricForce> raceNonparametric(const Search& search, const Effects& chosen,
                                                    const Fit& smoothing, const Options& options,
                                                    double outputSd, const Search::Report& report,
                                                    int& fits);

}  // namespace info::discover
