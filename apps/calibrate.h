#pragma once

#include <memory>

#include "command.h"

namespace app {

/// `fisherhill calibrate MODEL TRIAL… --parameters …`: estimates parameters from measured motions;
/// writes calibrated.osim and, where the way from EMG to excitation was calibrated, the trials as
/// that model wants them.
std::unique_ptr<Command> calibrateCommand();

}  // namespace app
