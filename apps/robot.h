#pragma once

#include <memory>

#include "command.h"

namespace app {

/// `fisherhill robot double-pendulum|suspended-mass`: what an experiment with one of the two robots
/// would tell about its parameters, and how estimators fare on it. Status 1 if the data could not
/// tell the parameters apart.
std::unique_ptr<Command> robotCommand();

}  // namespace app
