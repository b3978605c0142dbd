#pragma once

#include <string>
#include <vector>

#include "discover_verdict.h"
#include "report.h"

namespace app {

/// What has no name: its size and rhythm, a formula, a force that follows the angle or the speed
/// alone; nothing where everything has a name.
std::vector<ReportPart> withoutName(const DiscoverFindings& findings);

/// How far the best force without a name is behind the names, in a sentence; "" where it was not
/// raced, where it wins, or where there are no names.
std::string namesAgainstForces(const DiscoverFindings& findings);

}  // namespace app
