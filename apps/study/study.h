#pragma once

#include <functional>
#include <memory>

#include "command/command.h"
#include "ensemble/worker_pool.h"
#include "study/study_subject.h"

namespace app {

/// `fisherhill study run STUDY.toml`
/// @param gather makes the pool that computes the subjects
/// @param commands the program's, which it runs for a subject
std::unique_ptr<Command> studyCommand(std::function<std::unique_ptr<WorkerPool>()> gather,
                                      CommandList commands);

}  // namespace app
