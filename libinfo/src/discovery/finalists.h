#pragma once

#include <vector>

#include "discovery/search/search.h"

namespace info::discover {

/// All hypotheses that were raced and could be simulated, the most probable first, with
///     P(h) ∝ Z_h·(1/2M)^k
/// for k effects of M candidates.
std::vector<Finalist> finalistsOf(const Search& search);

}  // namespace info::discover
