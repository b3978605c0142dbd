#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill robot double-pendulum|suspended-mass`: finds the motion that is most informative
/// about the robot's parameters (robot_optimise.h), or computes the information of a given motion
/// and the performance of estimators on it. Status 1 if the parameters are not separately
/// identifiable, or if no better motion was found.
std::unique_ptr<Command> robotCommand();

}  // namespace app
