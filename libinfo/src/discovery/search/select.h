#pragma once

#include "discovery/search/effect_sets.h"
#include "discovery/search/search.h"

namespace info::discover {

/// Greedy selection from the calibrated base: an effect at a time, each earning its place by
/// Options::evidence and significant beside the others, each then tried against its rivals; at most
/// Options::maxEffects. None: empty.
Effects select(Search& search, const Options& options);

}  // namespace info::discover
