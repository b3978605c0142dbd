#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command/command.h"

namespace app {

/// Reads the command line, runs the subcommand it names and turns every exception into one line on
/// standard error, `fisherhill SUBCOMMAND: message`.
/// @param arguments as given to main, program name first
/// @return the exit status, one of ExitStatus
int runProgram(const std::vector<std::string>& arguments,
               std::vector<std::unique_ptr<Command>> commands);

}  // namespace app
