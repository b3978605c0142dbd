#pragma once

#include "generator/subject.h"

namespace hidden {

/// A trial that nobody steers: random pulses of the flexors and of the extensors are played to the
/// muscles, each with its own share of them, and no feedback looks at the arm. It starts at rest
/// but not balanced, anywhere between 5 and 120°; where it goes, and whether it ends at rest,
/// moving or at an end of its range, is up to it. The last pulse of one trial in four is over 1.5 s
/// before its end.
/// @throws std::runtime_error where the arm leaves −12 … 140°, a little more than its range, or the
///   muscles have no motion
Trial makeOpenLoopTrial(const Truth& truth, const TrialPlan& plan, RandomNumbers& random);

}  // namespace hidden
