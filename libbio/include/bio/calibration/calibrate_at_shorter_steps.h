#pragma once

#include <memory>
#include <vector>

#include "bio/calibration/calibrate.h"

namespace bio {

/// Changes at the estimate if the step of the simulations were halved.
struct StepChange {
  /// The channel of each trial that changes most relative to its noise.
  std::vector<LargestDifference> ofTrials;
  /// Largest change of an estimate, in its standard deviations: of θ by (I + Λ)⁻¹ΓᵀΔy/σ² to first
  /// order, parameters at a bound fixed. 0 where no estimate has a standard deviation.
  double ofEstimates = 0;
  /// Whether the change of a trial exceeds 0.2 standard deviations of a channel's noise.
  bool mattersToTrial(std::size_t trial) const;
  /// Whether that of an estimate exceeds 0.25 of its standard deviation.
  bool mattersToEstimates() const;
  /// Either: then the step passes for an error of the model.
  bool matters() const;
};

/// A calibration with the trials that it was made of.
struct SteppedCalibration {
  CalibrationOptions options;                         ///< with the step of the estimate
  std::unique_ptr<const TrialSet> training, heldOut;  ///< at that step; heldOut may be null
  Calibration calibration;
  StepChange change;  ///< empty if there is no estimate
};

/// calibrate(), again at half the step, from the estimate found, as long as halving the step of
/// vi or vi-left matters and the step is not below `shortest` then. Held-out trials have starts of
/// their own if the others have (TrialSetOptions::ownStart); their latent excitations are what the
/// trials say.
/// @param shortest [s] > 0; infinity: at the given step only
/// @throws std::invalid_argument what TrialSet and calibrate throw
SteppedCalibration calibrateAtShorterSteps(const Model& model, const SystemOptions& system,
                                           const std::vector<Trial>& training,
                                           const std::vector<Trial>& heldOut,
                                           const CalibrationOptions& options, double shortest);

/// [s], a default for `shortest`
inline constexpr double shortestCalibrationStep = 0.001;

}  // namespace bio
