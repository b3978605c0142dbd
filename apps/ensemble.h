#pragma once

#include <functional>
#include <memory>

#include "command.h"
#include "crew.h"

namespace app {

/// `fisherhill ensemble MODEL TRIAL`: many simulations with drawn parameters.
/// @param gather makes the worker pool
std::unique_ptr<Command> ensembleCommand(std::function<std::unique_ptr<Crew>()> gather);

}  // namespace app
