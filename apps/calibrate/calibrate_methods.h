#pragma once

#include "calibrate/calibrate_report.h"
#include "output/methods.h"

namespace app {

/// How the estimates and their intervals were made.
void sayCalibration(const CalibrateFindings& findings, Methods& methods);

}  // namespace app
