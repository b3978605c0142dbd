#pragma once

#include <vector>

#include "discover/discover_verdict.h"
#include "report/report.h"

namespace app {

/// Where simulation and data disagree: score over time and over angle and speed, missing force,
/// score by input; empty if this was not computed.
std::vector<ReportPart> whereTheyDisagree(const DiscoverFindings& findings);

}  // namespace app
