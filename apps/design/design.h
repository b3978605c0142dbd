#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill design MODEL TRIAL`: finds the experiment that is most informative about chosen
/// parameters.
std::unique_ptr<Command> designCommand();

}  // namespace app
