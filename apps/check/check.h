#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `fisherhill check FILE…`: reads models and trials and lists errors and unusual values. Status 0:
/// no error (warnings are possible); 1: a file has an error; 2: wrong use, or a file that does not
/// exist.
std::unique_ptr<Command> checkCommand();

}  // namespace app
