#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `sensitivity`: parameter sweeps, exact sensitivities, information, bounds, identifiability;
/// profile likelihood; Morris's and Sobol's global sensitivity.
std::unique_ptr<Command> sensitivityCommand();

}  // namespace app
