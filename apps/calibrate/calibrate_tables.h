#pragma once

#include "calibrate/calibrate_report.h"

namespace app {

/// Of all estimates but the knots of latent excitations.
Table correlationTable(const CalibrateFindings& findings);
/// What the search found from every start.
Table startTable(const CalibrateFindings& findings);

}  // namespace app
