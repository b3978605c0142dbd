#pragma once

#include "discovery/search/search.h"
#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// Compares non-parametric forces, each on one axis and a smooth function of its position or speed
/// alone,
/// with the effects that a search has chosen, or with none
/// (docs/decisions/047-nonparametric-forces.md). Returns the better one; empty if the problem does
/// not offer formulas, or if neither could be fitted.
/// @param smoothing fit of the base model with latent force, which follows the measured motion
/// @param fits is increased by the number of fits
std::optional<NonparametricForce> raceNonparametric(const Search& search, const Effects& chosen,
                                                    const Fit& smoothing, const Options& options,
                                                    const Whitening& sds,
                                                    const Search::Report& report, int& fits);

}  // namespace info::discover
