#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill emg RAW --config C.toml`: raw EMG to excitations; writes excitations.sto, a trial
/// ready for replay, with the measured coordinate if the configuration names one.
std::unique_ptr<Command> emgCommand();

}  // namespace app
