#pragma once

#include <functional>
#include <memory>

#include "command/command.h"
#include "ensemble/worker_pool.h"

namespace app {

/// `fisherhill ensemble MODEL TRIAL`: many simulations with drawn parameters.
/// @param gather makes the worker pool
std::unique_ptr<Command> ensembleCommand(std::function<std::unique_ptr<WorkerPool>()> gather);

}  // namespace app
