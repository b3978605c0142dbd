#pragma once

#include <memory>

#include "command.h"

namespace app {

/// fisherhill design: the experiment that tells most about chosen parameters.
std::unique_ptr<Command> designCommand();

}  // namespace app
