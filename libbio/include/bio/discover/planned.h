#pragma once

#include <string>
#include <vector>

#include "bio/trial.h"

namespace bio::discover {

/// An experiment that has not been done yet: a trial that was recorded, with the same EMG, repeated
/// with something changed that the experimenter knows.
struct PlannedExperiment {
  std::string sentence;  ///< what to do
  Trial trial;
};

/// What is easily done with an arm: a known mass in the hand (0.1 to 1 kg, besides one that is
/// there already), and recorded pushes of 0.2 s from outside on the coordinate, ±0.25 to ±1 N·m (N
/// for a translation), one a second. The first is no change.
/// @param trial       recorded; its torque from outside stays
/// @param coordinate  what is pushed and observed
std::vector<PlannedExperiment> plannedExperiments(const Trial& trial, const Coordinate& coordinate);

}  // namespace bio::discover
