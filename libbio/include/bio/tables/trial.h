#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/tables/experimental_conditions.h"
#include "bio/tables/latent_excitation.h"
#include "bio/tables/observable.h"

namespace bio {

/// External load on one coordinate, in every row.
struct AppliedForce {
  std::string coordinate;
  Eigen::VectorXd values;     ///< [N·m] or [N], finite; positive pushes the coordinate up
  std::string actuator = {};  ///< the CoordinateActuator whose control the column is; empty: none
  Eigen::VectorXd control = {};  ///< of that actuator, in every row
  double optimalForce = 0;       ///< with which it makes `values`; 0 if it is switched off
};

/// The inputs of a simulation and the measurements of a recording.
struct Trial {
  std::string file;
  std::string sha256;                ///< of that file, if the caller sets it; else empty
  Eigen::VectorXd times;             ///< [s] strictly rising, at least 2
  std::vector<std::string> muscles;  ///< every enabled muscle of the model, in its order; then
                                     ///< those switched off that have a column
  Eigen::MatrixXd excitations;       ///< 0 to 1; one row per time, one column per muscle
  std::vector<AppliedForce> applied;
  /// All that was measured: coordinates that are simulated, or locked, first; then everything else.
  std::vector<MeasuredChannel> measured;
  /// The course of coordinates of TrialOptions::prescribed and held; one sample: a constant.
  std::vector<MeasuredChannel> prescribed;
  ExperimentalConditions conditions;
  /// Muscles without an electrode, whose column is only what is expected: calibration may correct
  /// it (header line `latent_excitation`, latent_excitation.h).
  std::vector<LatentDeclaration> latent;
  std::vector<std::string> warnings;  ///< one line each

  /// [s]
  double duration() const { return times[times.size() - 1] - times[0]; }
  /// The measured channel of this observable; null: it was not measured.
  const MeasuredChannel* measurementOf(const Observable& what) const;
};

struct TrialOptions {
  bool ignoreExtra = false;  ///< ignore unknown columns, with a warning
  double baseline = 0.01;    ///< excitation of a muscle without a column, 0 to 1
  /// Whether the caller takes Trial::known into account; if not, a trial with such conditions is
  /// refused.
  bool experimentalConditions = false;
  /// Coordinates whose measured course is the motion that they make.
  std::vector<std::string> prescribed = {};
  /// Coordinates held at a value [rad] or [m], which may not have a column that differs.
  std::map<std::string, double> held = {};
};

/// Reads a .sto, .mot or .csv table as a trial of the model: column `time` [s], one column per
/// driven muscle (0 to 1 in every row), and a column per measured coordinate – an angle is in
/// degrees when the header says inDegrees=yes or the name ends in `_deg`, else in radians. A column
/// `elbow_flexion.torque` [N·m] (for a translation: `.force` [N]) is an external load. Other
/// measured columns are named as Observable says; a speed is in degrees per second and a pennation
/// in degrees when the header says inDegrees=yes or the name ends in `_deg`. Header lines give
/// Trial::known (known_changes.h); another line that begins with known_ is an error, and one that
/// nearly matches inDegrees or such a line gets a warning. OpenSim's paths count as names:
/// `/forceset/BRA/activation` is not an excitation, `/forceset/BRA` and
/// `/jointset/elbow/elbow_flexion/value` are understood. Empty cells and NaN: not measured. A
/// muscle without a column gets the baseline, with a warning.
/// @throws FileError naming file, column and row for a value outside its range, a prescribed
///   coordinate without a column, or whose values do not cover the trial, a muscle or a torque with
///   gaps, an unknown column, two columns with the same meaning, experimental
///   conditions that are out of range or that the caller cannot take into account, or a table that
///   table_file.h refuses
Trial readTrial(const std::filesystem::path& file, const Model& model,
                const TrialOptions& options = {});

/// Excitation of muscle `muscle` (an index of Trial::muscles) at time t [s], linear between rows,
/// constant outside.
double excitationAt(const Trial& trial, Eigen::Index muscle, double t);

}  // namespace bio
