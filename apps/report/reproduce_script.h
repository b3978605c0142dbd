#pragma once

#include <string>

#include "output/command_context.h"
#include "output/summary.h"

namespace app {

/// reproduce.sh: a shell script that checks the inputs' SHA-256 and the program's version, runs the
/// command again into another folder and compares the numbers of the two summary.json. It works
/// from any folder, and finds relative inputs where they were, seen from the result or from the
/// root. Empty if the result is a part of another command's, whose own script makes it again.
std::string reproduceScript(const CommandContext& context, const Summary& summary);

}  // namespace app
