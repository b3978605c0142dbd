#pragma once

// Not public.

#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// What a fit says of quantities; those that it holds fixed are left out.
std::vector<Estimate> estimatesOf(const Fit& fit, const std::vector<std::size_t>& wanted,
                                  const DiscoveryProblem& data);

}  // namespace info::discover
