#pragma once

#include <string>

#include "command/described_commands.h"

namespace app {

/// The man page fisherhill(1), in roff: every subcommand, argument and option of the program.
/// Options that all subcommands share are listed once, under COMMON OPTIONS.
std::string manualPage(const DescribedCommand& program, const std::string& version);

/// The man page of a separate program that carries out one subcommand, such as fisherhill-mpi(1).
/// @param name     the program's name
/// @param command  the subcommand it does
/// @param when when `fisherhill` starts it, one sentence
/// @param before words before the program on the command line; may be empty
/// @throws std::invalid_argument if there is no such subcommand
std::string helperPage(const DescribedCommand& program, const std::string& version,
                       const std::string& name, const std::string& command, const std::string& when,
                       const std::string& before);

}  // namespace app
