#pragma once

#include <optional>

#include "calibrate/calibrate_report.h"

namespace app {

/// What the calibrated model predicts of a held-out series, and how sure it is.
struct PredictedSeries {
  std::string file, channel, unit;
  /// The values farthest from 0, wherever each has it.
  double measuredPeak = 0, predictedPeak = 0;
  double sdOfEstimates = 0;  ///< of the predicted peak
  double noise = 0;          ///< of one sample: of the residuals of the calibration trials
  double lower = 0, upper = 0;
  /// Empty and NaN where the noise is unknown, because no calibration trial has the channel.
  std::optional<bool> holdsPeak = {};
  double shareHeld = 0;  ///< of all samples that lie within the interval of their own prediction
};

/// Intervals of options.confidence from the covariance of the estimates and the noise of single
/// samples. Noise that slowly varies, being error of the model, is in the latter.
std::vector<PredictedSeries> predictedSeries(const CalibrateFindings& findings);

/// Sets `held_out_predictions`.
void tellPredictions(const CalibrateFindings& findings, Summary& summary);
Table predictionTable(const CalibrateFindings& findings);

}  // namespace app
