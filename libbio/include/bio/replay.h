#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/coupled.h"
#include "bio/table_file.h"
#include "bio/trial.h"

/// What joins a recorded trial to a simulated arm.
namespace bio {

/// The trial's excitations in the order of the arm's muscles.
/// @throws std::invalid_argument if the trial lacks one of them
ExcitationSignal excitationOf(const Trial& trial, const Arm& arm);

/// What pushes the arm from outside in a trial; none if the trial has no such column.
/// @throws std::invalid_argument if it pushes a coordinate that is not free
ExternalForce externalForceOf(const Trial& trial, const Arm& arm);

/// Start values of the free coordinates [rad] or [m]: as given, else the first measured value, else
/// the default.
/// @throws std::invalid_argument for a name that is not free, or a value that is not finite
Eigen::VectorXd startCoordinates(const Trial& trial, const Arm& arm,
                                 const std::map<std::string, double>& given);

/// When the coordinate was measured [s]; if it was not, the trial's times at equal steps.
std::vector<double> observedTimes(const Trial& trial, const std::string& coordinate, double step);

/// How far a simulation is from a measured coordinate, at the measured times that it covers.
struct MeasuredError {
  double rms = 0;          ///< [rad] or [m]
  double largest = 0;      ///< [rad] or [m]
  double largestAt = 0;    ///< [s]
  Eigen::Index count = 0;  ///< measured values compared
};
/// @throws std::invalid_argument if the coordinate is not free, or no measured time is covered
MeasuredError compareWithMeasured(const Arm& arm, const Trajectory& trajectory,
                                  const MeasuredMotion& measured);

/// One sentence for each free coordinate that leaves its range in the model, and when: nothing but
/// the model's own passive forces holds it there.
std::vector<std::string> rangeRemarks(const Arm& arm, const Trajectory& trajectory);

/// Where a motion first leaves what its model is made for.
struct LeftRange {
  double time = 0;   ///< [s]
  std::string name;  ///< of the coordinate or muscle
  std::string what;  ///< one sentence without full stop: what, when, how far
};
/// The first time at which a free coordinate is outside its range by more than a tenth of it (and
/// 1° or 1 mm), or a fibre outside 0.2 to 2 optimal lengths; nothing if there is none.
std::optional<LeftRange> leftRange(const Arm& arm, const Trajectory& trajectory);

/// States as OpenSim 4 names them: value and speed of every coordinate of the model (locked and
/// coupled ones too), activation and fiber_length of every simulated muscle; radians and metres.
Table statesTable(const Model& model, const Arm& arm, const Trajectory& trajectory);

/// Tendon forces [N], one column per muscle.
Table forcesTable(const Arm& arm, const Trajectory& trajectory, const MuscleReport& report);

/// Lengths and moment arms of muscles over the range of one coordinate.
struct PathSample {
  Eigen::VectorXd value;  ///< of the coordinate [rad] or [m]
  std::vector<std::string> muscles;
  Eigen::MatrixXd length;          ///< rows = values, columns = muscles [m]
  Eigen::MatrixXd momentArm;       ///< −∂ℓ/∂q [m]
  Eigen::MatrixXd momentArmSlope;  ///< −∂²ℓ/∂q² [m/rad]
  Eigen::MatrixXi wrapped;         ///< 1: a wrap object is touched
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< muscles left out that cannot be computed
};
/// Paths of every enabled muscle that the skeleton's first coordinate moves, whatever its class;
/// the other free coordinates stay at their defaults.
/// @throws std::invalid_argument what MusclePath throws
PathSample samplePaths(const Model& model, const Skeleton& skeleton,
                       const std::vector<std::string>& wrapAsCylinder,
                       const Eigen::VectorXd& values);

}  // namespace bio
