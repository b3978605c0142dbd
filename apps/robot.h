#pragma once

#include <memory>

#include "command.h"

namespace app {

/// `fisherhill robot double-pendulum|suspended-mass`: the motion that tells most about the robot's
/// parameters (robot_optimise.h); or what a given motion would tell, and how estimators fare on it.
/// Status 1 if the data could not tell the parameters apart, or if no better motion was found.
std::unique_ptr<Command> robotCommand();

}  // namespace app
