#pragma once

#include "calibrate/calibrate_report.h"

namespace app {

/// Correlations of all estimates but the knots of latent excitations.
Table correlationTable(const CalibrateFindings& findings);
/// Results of the search from every start.
Table startTable(const CalibrateFindings& findings);

}  // namespace app
