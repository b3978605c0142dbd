#pragma once

#include "discover_verdict.h"
#include "report.h"

namespace app {

/// Verdict, motions before and after, where they disagreed, evidence, parameters, gap, tests of
/// what is left, what these data could not have shown, next experiment.
Report discoverReport(const DiscoverFindings& findings);

}  // namespace app
