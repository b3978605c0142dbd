#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bio/emg/emg_mapping.h"
#include "bio/parameters/parameters.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"

/// Inputs, initial state and errors of simulating a recorded trial.
namespace bio {

/// The trial's excitations in the order of the system's muscles.
/// @throws std::invalid_argument if the trial lacks one of them
ExcitationSignal excitationOf(const Trial& trial, const MusculoskeletalSystem& system);

/// The external force of a trial; none if the trial has no such column.
/// @throws std::invalid_argument if it acts on a coordinate that is not free
ExternalForce externalForceOf(const Trial& trial, const MusculoskeletalSystem& system);

/// The motion of the system's prescribed coordinates in a trial: what that gives, else the model's
/// own functions of time.
/// @throws std::invalid_argument if the trial lacks one of them
PrescribedMotion prescribedMotionOf(const Trial& trial, const MusculoskeletalSystem& system);

/// Inputs to the simulation of a recorded trial, for one system.
struct RecordedTrial {
  ExcitationSignal excitation;   ///< excitationOf()
  SimulationOptions simulation;  ///< from the first row to the last, with externalForceOf() and
                                 ///< prescribedMotionOf()

  /// The state at the first row, fibres in equilibrium with the tendons.
  /// @throws what initialState throws
  SystemState startAt(const MusculoskeletalSystem& system, const StartPoint& point) const;
};
/// @param options  integrator, step and progress
/// @throws what excitationOf, externalForceOf and prescribedMotionOf throw
RecordedTrial recordedTrial(const Trial& trial, const MusculoskeletalSystem& system,
                            SimulationOptions options);

/// Smooths the prescribed courses of a trial (smoothed_motion.h), sampled at equal steps from its
/// first row to its last; constants stay.
/// @param cutoff  [Hz] > 0
/// @throws std::invalid_argument what smoothed() throws
void smoothPrescribed(Trial& trial, double cutoff);

/// One sentence for each prescribed course whose acceleration is mostly noise of the measurement.
std::vector<std::string> roughnessRemarks(const Trial& trial, const Model& model);

/// Initial values of the free coordinates [rad] or [m]: prescribed ones as their course begins, the
/// others as given, else the first measured value,
/// else the default.
/// @throws std::invalid_argument for a name that is not free, or is prescribed, or a value that is
///   not finite
Eigen::VectorXd startCoordinates(const Trial& trial, const MusculoskeletalSystem& system,
                                 const std::map<std::string, double>& given);

/// Initial state of a trial's simulation, and its source.
struct TrialBeginning {
  enum class From { given, model, measured, defaults };
  StartPoint point;
  From from = From::defaults;  ///< the first in this order of the coordinates' sources: model,
                               ///< given, measured
};
const char* name(TrialBeginning::From from);  ///< "given", "model", "measured", "default"

/// Initial values and speeds of the free coordinates: as given, at rest; else as fitted with the
/// model (Model::fitted), if it contains the trial's SHA-256; else the first measured value, else
/// the default, at rest.
/// @throws std::invalid_argument as startCoordinates does
TrialBeginning beginningOf(const Trial& trial, const Model& model,
                           const MusculoskeletalSystem& system,
                           const std::map<std::string, double>& given);

/// Time step [s]: the one given, else, for the variational integrators, the one with which the
/// model was fitted, else the integrator's default.
double stepOf(const Model& model, Integrator integrator, const std::optional<double>& given);

/// Times at which the coordinate was measured [s]; if it was not, the trial's duration at equal
/// steps.
std::vector<double> observedTimes(const Trial& trial, const std::string& coordinate, double step);

/// Error of a simulation against a measured coordinate, at the measured times that it covers.
struct MeasuredError {
  double rms = 0;          ///< [rad] or [m]
  double largest = 0;      ///< [rad] or [m]
  double largestAt = 0;    ///< [s]
  Eigen::Index count = 0;  ///< measured values compared
};
/// @throws std::invalid_argument if the coordinate is not free, or no measured time is covered
MeasuredError compareWithMeasured(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                                  const MeasuredChannel& measured);

/// Error against any other measured channel.
struct ChannelError {
  Observable what;
  MeasuredError error;  ///< in unitOf(what)
};

/// A simulated trial, with its errors against the measurement.
struct TrialReplay {
  TrialBeginning beginning;
  EmgMapping mapping;         ///< through which the excitations passed
  SimulationOptions options;  ///< as they were used
  Trajectory motion;
  /// For every free coordinate with a measured value that the motion reaches.
  std::vector<std::pair<std::string, MeasuredError>> errors;
  std::vector<ChannelError> channelErrors;  ///< of the trial's channels that the motion reaches
};

/// The motion that `fisherhill replay MODEL TRIAL` makes over all rows of the trial.
/// @param options integrator, step and progress; times and the external torque are those of the
///   trial
/// @param beginning from beginningOf()
/// @param mapping  through which the trial's excitations pass
/// @throws what excitationOf, externalForceOf, drivenExcitation, initialState and simulate throw
TrialReplay replayTrial(const MusculoskeletalSystem& system, const Trial& trial,
                        SimulationOptions options, TrialBeginning beginning,
                        const EmgMapping& mapping = {});

/// Time at which a motion leaves the valid range of its model.
struct LeftRange {
  double time = 0;   ///< [s]
  std::string name;  ///< of the coordinate or muscle
  std::string what;  ///< one sentence without full stop
};
/// Each free coordinate that leaves its range in the model, with the first time; only the model's
/// passive forces limit it.
std::vector<LeftRange> leftRanges(const MusculoskeletalSystem& system,
                                  const Trajectory& trajectory);
/// The first time at which a free coordinate is outside its range by more than a tenth of it (and
/// 1° or 1 mm), or a fibre outside 0.2 to 2 optimal lengths; nothing if there is none.
std::optional<LeftRange> leftRange(const MusculoskeletalSystem& system,
                                   const Trajectory& trajectory);

/// States as OpenSim 4 names them: value and speed of every coordinate of the model (locked and
/// coupled ones too), activation and fiber_length of every simulated muscle; radians and metres.
Table statesTable(const Model& model, const MusculoskeletalSystem& system,
                  const Trajectory& trajectory);

/// Tendon forces [N], one column per muscle, and NAME.reaction [N·m] or [N] of each prescribed
/// coordinate: what keeps it on its course.
Table forcesTable(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                  const MuscleReport& report);

}  // namespace bio
