#pragma once

#include <string>

#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// A verdict in one or a few sentences, with which samples were not used.
/// @param somethingChosen  whether the search ended with an effect, named or not
std::string verdictSentence(const DiscoveryProblem& data, const Verdict& verdict,
                            const Options& options, bool somethingChosen);

}  // namespace info::discover
