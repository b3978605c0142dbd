#pragma once

#include <memory>

#include "command.h"

namespace app {

/// `sensitivity`: sweeps of parameters, exact sensitivities, information, bounds and what cannot be
/// told apart; profile likelihood; Morris's and Sobol's global sensitivity.
std::unique_ptr<Command> sensitivityCommand();

}  // namespace app
