#pragma once

#include "discover/discover_verdict.h"
#include "report/report.h"

namespace app {

/// Verdict, motions before and after, where model and data disagree, evidence, parameters, excess
/// error, tests of the residuals, smallest detectable effects, next experiment.
Report discoverReport(const DiscoverFindings& findings);

}  // namespace app
