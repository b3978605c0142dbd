#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill discover MODEL TRIAL…`: finds where simulation and data disagree, names the missing
/// effect and adds it; writes verdict.json and with_effect.osim.
std::unique_ptr<Command> discoverCommand();

}  // namespace app
