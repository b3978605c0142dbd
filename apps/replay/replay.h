#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `replay`: simulates the motion produced by a trial's excitations and compares it with the
/// measurement.
std::unique_ptr<Command> replayCommand();

}  // namespace app
