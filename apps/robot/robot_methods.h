#pragma once

#include "output/methods.h"
#include "robots/robot_experiments.h"
#include "robots/robot_information.h"
#include "robots/robot_motion.h"
#include "robots/string_length.h"

namespace app {

/// What is to be said of a motion of a robot that was optimised.
void sayMotion(const info::robot::MotionRequest& request, const info::robot::MotionResult& found,
               Methods& methods);

/// What is to be said of the information of a given motion.
/// @param trials  simulated experiments; 0: none
void sayInformation(const info::robot::ExperimentRequest& request,
                    const info::PlannedExperiment& plan, int trials, std::uint64_t seed,
                    Methods& methods);

/// What is to be said of estimators that were compared.
void sayConvergence(const info::robot::ExperimentRequest& request, std::uint64_t seed,
                    Methods& methods);

/// What is to be said of a string's length that an arm estimates while it moves.
void sayStringLength(const info::robot::StringLengthRequest& request,
                     const info::robot::StringLengthResult& found, Methods& methods);

}  // namespace app
