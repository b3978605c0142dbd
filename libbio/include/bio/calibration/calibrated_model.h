#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/calibration/calibrate.h"
#include "bio/tables/table_file.h"

namespace bio {

/// One trial of a calibration, replayed with the calibrated model.
struct CalibratedTrial {
  std::size_t index = 0;  ///< in its set
  bool isHeldOut = false;
  std::vector<TrialStart> starts;  ///< of every free coordinate
  std::optional<Table> driven;     ///< trial to replay instead, if the relation between EMG and
                                   ///< excitation was estimated
  double after = std::numeric_limits<double>::quiet_NaN();  ///< root mean square error of the
                                                            ///< measured angles [rad]; NaN: none
  Eigen::Index samples = 0;                                 ///< samples of `after`
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

/// @param arm options with which both sets were constructed
/// @param heldOut     null: none
/// @param simulation  integrator and step of the calibration
/// @param calibration with an estimate
CalibratedModel calibratedModel(const TrialSet& training, const TrialSet* heldOut,
                                const SystemOptions& arm, const SimulationOptions& simulation,
                                const Calibration& calibration);

}  // namespace bio
