#pragma once

#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// Memory that a search of the trials needs at least [bytes]: 32 Σ n m over the trials, with n
/// samples and m nodes of the latent force. Four matrices of n × m numbers live at a time (measured
/// on trials of 20 and 40 s).
double neededMemory(const DiscoveryProblem& data, const std::vector<int>& trials);

/// Memory that this process may still take [bytes]: what the system has available, or what its
/// control group leaves if that is less; infinite where neither can be read.
double availableMemory();

/// @throws std::invalid_argument if the needed memory is more than `available` [bytes]: how much
///   both are, and what can be done
void requireMemory(const DiscoveryProblem& data, const std::vector<int>& trials, double available);

}  // namespace info::discover
