#pragma once

#include <vector>

#include "bio/analysis/driven_trial.h"
#include "bio/calibration/calibrate.h"

namespace bio {

/// One trial of a calibration, replayed with the calibrated model; `after` [rad] is the error of
/// all measured angles.
struct CalibratedTrial : FittedTrial {
  std::vector<ChannelError> channels = {};  ///< errors of all that was measured beside angles
};

/// The model at the estimate, with initial states and time step (Model::fitted), and the RMS errors
/// of its replays.
struct CalibratedModel {
  Model model;
  std::vector<CalibratedTrial> trials;

  /// RMS error over the held-out or the calibration trials [rad]; NaN if one of them has none.
  double rms(bool heldOut) const;
};

/// @param system options with which both sets were constructed
/// @param heldOut     null: none
/// @param simulation  integrator and step of the calibration
/// @param calibration with an estimate
CalibratedModel calibratedModel(const TrialSet& training, const TrialSet* heldOut,
                                const SystemOptions& system, const SimulationOptions& simulation,
                                const Calibration& calibration);

}  // namespace bio
