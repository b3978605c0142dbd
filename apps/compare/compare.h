#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `compare`: integrators at time steps, against a converged reference.
std::unique_ptr<Command> compareCommand();

}  // namespace app
