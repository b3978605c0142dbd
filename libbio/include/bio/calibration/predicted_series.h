#pragma once

#include <optional>
#include <vector>

#include "bio/calibration/calibrate.h"

namespace bio {

/// Prediction of a held-out series by a calibrated model, and how sure it is; in the channel's
/// unit, angles in rad.
struct PredictedSeries {
  std::size_t series = 0;  ///< of the held-out trials' series()
  /// The values farthest from 0, wherever each has it.
  double measuredPeak = 0, predictedPeak = 0;
  double sdOfEstimates = 0;  ///< of the predicted peak
  double noise = 0;          ///< of one sample: of the residuals of the calibration trials
  double lower = 0, upper = 0;
  /// Empty and NaN where the noise is unknown, because no calibration trial has the channel.
  std::optional<bool> holdsPeak = {};
  double shareHeld = 0;  ///< of all samples that lie within the interval of their own prediction
};

/// Intervals from the covariance of the estimates and the noise of single samples,
/// ŷ ± z √(sd² + σ²). Noise that slowly varies, being error of the model, is in σ.
/// @param confidence  in (0, 1)
/// @return one per series; none without an estimate
std::vector<PredictedSeries> predictedSeries(const TrialSet& training, const TrialSet& heldOut,
                                             const Calibration& calibration, double confidence);

}  // namespace bio
