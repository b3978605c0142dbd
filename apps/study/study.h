#pragma once

#include <functional>
#include <memory>

#include "command/command.h"
#include "ensemble/worker_pool.h"

namespace app {

/// `fisherhill study run STUDY.toml`
/// @param gather makes the pool that computes the subjects
std::unique_ptr<Command> studyCommand(std::function<std::unique_ptr<WorkerPool>()> gather);

}  // namespace app
