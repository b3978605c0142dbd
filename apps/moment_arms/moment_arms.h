#pragma once

#include <memory>

#include "command/command.h"

namespace app {

/// `moment-arms`: lengths, moment arms and their slopes over a coordinate's range.
std::unique_ptr<Command> momentArmsCommand();

}  // namespace app
