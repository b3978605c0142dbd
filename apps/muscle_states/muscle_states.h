#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `muscle-states`: what the muscle laws give for rows of class, parameters and state.
std::unique_ptr<Command> muscleStatesCommand();

}  // namespace app
