#pragma once

#include "generator/subject.h"

namespace hidden {

/// The person is relaxed, and somebody else moves the forearm slowly from 13 to 110° and back, with
/// an unsteady hand, and records the torque of doing so. Starts at rest, balanced; `duration`,
/// `rate` and `angleNoise` of the plan mean what they mean for a person, the rest nothing.
/// @throws std::runtime_error where the arm is not held: an angle outside 2 … 128°
Trial makePassiveTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random);

}  // namespace hidden
