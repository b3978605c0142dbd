#pragma once

#include <memory>

#include "command.h"

namespace app {

/// `replay`: simulates the motion that a trial's excitations make, beside what was measured.
std::unique_ptr<Command> replayCommand();

}  // namespace app
