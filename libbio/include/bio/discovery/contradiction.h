#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "bio/tables/trial.h"

namespace bio::discover {

/// Whether the recorded excitations and the recorded motion belong together, before anything is
/// fitted. Along the motion (smoothed, 3 Hz), inverse dynamics gives the moment that the muscles
/// have to make, and the moment that they make with the recorded excitations. Their correlation is
/// that of the deviations from each trial's means, over the trials; it does not depend on a common
/// factor of all muscles. Measured values of sets made by OpenSim, as they are and with wrong sign,
/// unit, time or trial: validation/discovery/README.md.
struct InputAgreement {
  static constexpr double tooSmall = 0.7;     ///< below: the recording may contradict itself
  static constexpr double largeEnough = 0.8;  ///< that of a remedy
  static constexpr double gain = 0.3;         ///< by which a remedy is larger
  static constexpr double unrelated = 0.3;    ///< below, without a remedy: nothing is believed

  /// Mean over the coordinates; NaN where it cannot be told: no muscles, a free coordinate that is
  /// not measured, constant moments.
  double correlation = NAN;
  /// Changes of the recording, each by itself, with which the correlation is large enough, as
  /// clauses ("the sign of elbow_flexion is reversed"), the best first; empty if there is none, or
  /// if the correlation is not too small. Tried are: supplement and unit (degrees taken for
  /// radians) of each angle, the sign of each angle and moment and of every two of them, a shift of
  /// the excitations by 0.3 to 2 s, and excitations of another of the trials.
  std::vector<std::string> remedies;
  double remedied = NAN;  ///< correlation with the first of them
};

/// Each trial is judged under its experimental conditions (withExperimentalConditions()).
/// @param coordinates  those in question
/// @param goOn  asked before every simulation of a changed recording; false: without remedies
/// @throws what withExperimentalConditions() and recordedTrial() throw
InputAgreement inputAgreement(
    const Model& model, const SystemOptions& system, const CoordinateNames& coordinates,
    const std::vector<Trial>& trials, const std::function<bool()>& goOn = [] { return true; });

}  // namespace bio::discover
