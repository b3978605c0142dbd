#pragma once

#include <optional>

#include "calibrate/calibrate_report.h"
#include "report/report.h"

namespace app {

/// The trials in three dimensions, held-out ones first: as calibrated, before, and as measured.
/// Nothing without an estimate.
std::optional<Playback> calibratePlayback(const CalibrateFindings& findings);

}  // namespace app
