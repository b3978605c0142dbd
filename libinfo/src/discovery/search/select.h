#pragma once

#include "discovery/search/effect_sets.h"
#include "discovery/search/search.h"

namespace info::discover {

/// Greedy selection from the calibrated base model: one effect at a time, each with a log Bayes
/// factor of at least Options::evidence and significant beside the others, each then compared with
/// its alternatives; at most Options::maxEffects. Empty if there is none.
Effects select(Search& search, const Options& options);

}  // namespace info::discover
