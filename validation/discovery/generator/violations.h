#pragma once

#include <string>
#include <vector>

#include "generator/subject.h"

namespace hidden {

/// An assumption that discovery makes of its data, broken.
struct Violation {
  std::string id, what;
};

/// All ten, in the order in which seeds choose them.
const std::vector<Violation>& violations();
/// @throws std::invalid_argument for an unknown id
const Violation& violation(const std::string& id);

/// The plan of a trial that is to be violated so: it may have to be longer, or noisier.
TrialPlan planFor(const Violation& violation, TrialPlan plan);

/// What such a laboratory writes down of a trial made to that plan: measured_deg, NaN where nothing
/// was measured, and the recorded EMG; a start in motion cuts the trial's begin off.
void violate(const Violation& violation, const Truth& truth, const TrialPlan& plan, Trial& trial,
             RandomNumbers& random);

}  // namespace hidden
