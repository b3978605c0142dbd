#pragma once

#include <string>

#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// A verdict in one or a few sentences, with which samples were not used.
/// @param farOff  Options::farOff
/// @param somethingChosen  whether the search ended with an effect, named or not
std::string verdictSentence(const DiscoveryProblem& data, const Verdict& verdict, double farOff,
                            bool somethingChosen);

}  // namespace info::discover
