#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "bio/calibrate.h"
#include "bio/table_file.h"

namespace bio {

/// One trial of a calibration as a replay of the calibrated model has it.
struct CalibratedTrial {
  std::size_t index = 0;  ///< in its set
  bool isHeldOut = false;
  std::vector<TrialStart> starts;  ///< of every free coordinate
  std::optional<Table> driven;     ///< what is to be replayed in its place, where the way from EMG
                                   ///< to excitation was estimated
  double after = std::numeric_limits<double>::quiet_NaN();  ///< root mean square error of the
                                                            ///< measured angles [rad]; NaN: none
  Eigen::Index samples = 0;                                 ///< that it is of
};

/// The model at a calibration's estimate, with starts and time step (Model::fitted), and what
/// replays of it give.
struct CalibratedModel {
  Model model;
  std::vector<CalibratedTrial> trials;

  /// Root mean square error over those held out, or the others [rad]; NaN if one has none.
  double rms(bool heldOut) const;
};

/// @param arm         options that both sets were made with
/// @param heldOut     null: none
/// @param simulation  integrator and step of the calibration
/// @param calibration with an estimate
CalibratedModel calibratedModel(const TrialSet& training, const TrialSet* heldOut,
                                const ArmOptions& arm, const SimulationOptions& simulation,
                                const Calibration& calibration);

}  // namespace bio
