#pragma once

#include "calibrate/calibrate_report.h"

namespace app {

/// Sets `held_out_predictions`.
void tellPredictions(const CalibrateFindings& findings, Summary& summary);
Table predictionTable(const CalibrateFindings& findings);

}  // namespace app
