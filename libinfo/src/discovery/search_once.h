#pragma once

#include "info/discovery/discover.h"

// Not public.

namespace info::discover {

/// run() with the samples and the noise given.
Verdict searchOnce(const DiscoveryProblem& data, const Options& options, const RecordedNoise& noise,
                   WarmStart* draft);

}  // namespace info::discover
