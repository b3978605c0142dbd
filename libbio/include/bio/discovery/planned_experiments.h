#pragma once

#include <string>
#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "bio/tables/trial.h"

namespace bio::discover {

/// A planned experiment: a recorded trial, repeated with the same EMG and a known change.
struct PlannedExperiment {
  std::string sentence;  ///< what to do
  Trial trial;
  bool keepsStart = true;  ///< begins where the recorded trial does
};

/// Experiments that are easy to do: a known mass at the end of the limb (0.1 to 1 kg, in addition
/// to one that is already there; none if no body can carry it), and recorded external pushes of
/// 0.2 s on the model's coordinate, ±0.25 to ±1 N·m (N for a translation), one per second. The
/// first one is an unchanged repetition.
/// @param trial the recorded trial; its external torque is kept
std::vector<PlannedExperiment> plannedExperiments(const Trial& trial,
                                                  const EncompassingModel& model);

}  // namespace bio::discover
