#pragma once

#include <vector>

#include "discover_verdict.h"
#include "report.h"

namespace app {

/// Where simulation and data disagree: over time, over angle and speed, the force that is missing,
/// by what drives; nothing if that was not looked for.
std::vector<ReportPart> whereTheyDisagree(const DiscoverFindings& findings);

}  // namespace app
