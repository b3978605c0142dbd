#pragma once

// Not public.

#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// Estimates of the wanted quantities by a fit; those that it holds fixed are left out.
std::vector<Estimate> estimatesOf(const Fit& fit, const std::vector<std::size_t>& wanted,
                                  const DiscoveryProblem& data);

}  // namespace info::discover
