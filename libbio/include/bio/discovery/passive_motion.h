#pragma once

#include <vector>

#include "bio/discovery/encompassing_model.h"
#include "bio/discovery/planned_experiments.h"

namespace bio::discover {

/// Planned passive motions: another person moves the relaxed limb slowly up and back and records
/// the torque, so that muscles hardly contribute and passive effects can be distinguished. With and
/// without 1 kg in the hand; with the limb as in the trial, and turned back by 45°, where gravity
/// acts in another direction.
///
/// The coordinate moves from 10 to 65 % of its range (85 % if turned) by minimum jerk; the
/// excitation of every muscle is its smallest value in the trial, at most 0.01. The torque [N·m]
/// (force [N]) is the one that keeps the model under these conditions on this motion
/// (inverse_dynamics.h), so that the limb follows as far as the model is right. An external torque
/// of the trial is replaced. Motions that the model cannot make are left out; empty if the model
/// has other free coordinates.
std::vector<PlannedExperiment> passiveMotions(const Trial& trial, const EncompassingModel& model);

}  // namespace bio::discover
