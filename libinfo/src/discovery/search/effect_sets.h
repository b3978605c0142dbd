#pragma once

// Sets of effects as sorted lists; not public.

#include <algorithm>
#include <vector>

namespace info::discover {

using Effects = std::vector<std::size_t>;  ///< indices into DiscoveryProblem::candidates(), sorted

inline Effects with(Effects effects, std::size_t another) {
  effects.insert(std::upper_bound(effects.begin(), effects.end(), another), another);
  return effects;
}

inline Effects without(Effects effects, std::size_t one) {
  effects.erase(std::find(effects.begin(), effects.end(), one));
  return effects;
}

}  // namespace info::discover
