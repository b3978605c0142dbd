#pragma once

#include <vector>

#include "discovery/search/search.h"

namespace info::discover {

/// All hypotheses that were raced and could be simulated, the most probable first; one in which an
/// effect more is present is half as probable beforehand, divided among all candidates.
std::vector<Finalist> finalistsOf(const Search& search);

}  // namespace info::discover
