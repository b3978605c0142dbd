#pragma once

#include <vector>

#include "bio/calibration/calibrate_at_shorter_steps.h"
#include "output/summary.h"

namespace app {

/// Warns of steps that are too long, which look like an error of the model.
/// @param asked  the step at which the calibration began [s]
void tellSteps(double asked, const bio::SteppedCalibration& found, Summary& summary);

/// One warning for each coordinate that the model prescribes and trials measure: the column is not
/// part of the fit.
void tellNotFitted(const bio::TrialSet& training, const std::vector<bio::Trial>& heldOut,
                   Summary& summary);

}  // namespace app
