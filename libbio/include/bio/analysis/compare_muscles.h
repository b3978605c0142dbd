#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bio/analysis/compare.h"
#include "bio/analysis/replay.h"
#include "bio/observation/parameter_information.h"

/// Comparison of a model's muscles in other classes, all their shared numbers being equal.
namespace bio {

/// Where a comparison of classes begins, and what is measured.
struct MuscleClassTrial {
  RecordedTrial recorded;          ///< with a variational integrator, which has sensitivities
  StartPoint start;                ///< fibres rest
  std::string coordinate = {};     ///< measured
  std::vector<double> times = {};  ///< of its samples [s]
  double noise = 0;                ///< standard deviation of a sample [rad] or [m] > 0
  /// Called between classes with the fraction of the work done.
  std::function<void(double)> progress = {};
};

/// The motion of a model with all muscles of one class.
struct MuscleClassMotion {
  std::string name;               ///< as asked for; "as in the model"
  std::vector<std::string> lost;  ///< by the conversion (convert_muscles.h)
  Trajectory motion;
  double energyError = 0;  ///< [J]
  Deviation difference;    ///< from the first class [rad]; 0 for the first
  /// Difference of the measured coordinate from the first class at the samples, RMS.
  double measured = 0;
  /// The rest of it if the first class's parameters are changed as its data would have them:
  /// linear least squares with their priors. Small: data cannot tell the classes apart.
  double unexplained = 0;
  /// About maximal force, optimal fibre length and tendon slack length of every muscle.
  ParameterInformation information;
};

/// Simulates the model as it is, then with all muscles of each class in turn.
/// @param classes  what convertMuscles() takes
/// @throws what convertMuscles, MusculoskeletalSystem and simulate throw; std::runtime_error: the
///   motion of the model itself does not reach the end
std::vector<MuscleClassMotion> compareMuscleClasses(const Model& model,
                                                    const SystemOptions& options,
                                                    const std::vector<std::string>& classes,
                                                    const MuscleClassTrial& trial);

}  // namespace bio
