#pragma once

#include <string>
#include <vector>

#include "discover/discover_verdict.h"
#include "report/report.h"

namespace app {

/// Report on an effect outside the catalogue: size and frequency of the missing force, a formula, a
/// free-form force of the angle or of the speed; empty if there is none.
std::vector<ReportPart> withoutName(const DiscoverFindings& findings);

/// Compares the best free-form force with the named effects, in a sentence; "" if it was not
/// fitted, if it wins, or if no effect was named.
std::string namesAgainstForces(const DiscoverFindings& findings);

}  // namespace app
