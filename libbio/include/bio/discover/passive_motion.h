#pragma once

#include <vector>

#include "bio/discover/planned.h"
#include "bio/discover/widest_model.h"

namespace bio::discover {

/// Somebody else moves the relaxed arm, slowly up and back, and records the torque: what the
/// muscles do hardly matters, and position, speed and weight are left to differ. With and without 1
/// kg in the hand; as it was, and with the whole arm turned back by 45°, where gravity holds it
/// over most of its range and comes from elsewhere.
///
/// From 10 to 65 % of the coordinate's range (85 % where turned) by minimum jerk; every muscle as
/// little excited as it ever was in the trial, and at most 0.01; the torque [N·m] (force [N])
///     τ = (M + m|v(q)|²)·q̈ + ½·∂M·q̇² + ∂V(q + t) − m·g·v(q + t) − passive − Σ F_T r,
///     v = ∂(mass centre of the hand)/∂q, m the known mass, t the known turn, F_T r at rest,
/// so that the arm follows roughly. A torque from outside that
/// the trial had is replaced. Empty if the arm has other free coordinates.
std::vector<PlannedExperiment> passiveMotions(const Trial& trial, const WidestModel& model);

}  // namespace bio::discover
