#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill calibrate MODEL TRIAL… --parameters …`: estimates parameters from measured motions;
/// writes calibrated.osim and, if the relation between EMG and excitation was calibrated, the
/// trials with the corrected excitations.
std::unique_ptr<Command> calibrateCommand();

}  // namespace app
