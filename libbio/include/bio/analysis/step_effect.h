#pragma once

#include <optional>
#include <string>

#include "bio/analysis/replay.h"

namespace bio {

/// Effect of half the step on a simulated trial.
struct StepEffect {
  double halfStep = 0;  ///< [s]
  std::string coordinate;
  bool turns = true;      ///< the coordinate is an angle
  double difference = 0;  ///< largest |q(h) − q(h/2)| [rad] or [m]
  double at = 0;          ///< when [s]
  std::string failed;     ///< why the motion with half the step did not reach the end; else empty
};

/// Difference up to which a motion counts as independent of its step: 2° or 20 mm, by judgement.
inline constexpr double largestStepEffect_deg = 2, largestStepEffect_mm = 20;

/// Simulates a replayed trial again with half its step and compares the motions at all rows of the
/// finer one: one test for every integrator, trial and length of step. Of cvode, which chooses its
/// own steps, it tests whether the rows show the motion.
/// @param replay  completed
/// @returns the coordinate that differs most, in units of the limits above, where that is beyond
///   them or the motion with half the step fails; nothing if the motion holds
/// @throws what replayTrial throws
std::optional<StepEffect> stepEffect(const MusculoskeletalSystem& system, const Trial& trial,
                                     const TrialReplay& replay);

/// stepEffect() of a completed replay whose step is in doubt: of an explicit integrator if it was
/// asked for, since it may be unstable, and of any integrator where there are at most 20 steps;
/// nothing of others.
/// @param wasGiven  the step was asked for
/// @throws what replayTrial throws
std::optional<StepEffect> effectOfDoubtfulStep(const MusculoskeletalSystem& system,
                                               const Trial& trial, const TrialReplay& replay,
                                               bool wasGiven);

/// "with half the step (0.05 s) elbow_flexion differs by up to 46.8 deg, at 1.83 s: the step of 0.1
/// s is too long for this trial"
std::string describe(const StepEffect& effect);

}  // namespace bio
