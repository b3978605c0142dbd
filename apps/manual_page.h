#pragma once

#include <string>

#include "described_commands.h"

namespace app {

/// The man page fisherhill(1), in roff: every subcommand, argument and option of the program.
/// Options that all subcommands share stand once, under COMMON OPTIONS.
std::string manualPage(const DescribedCommand& program, const std::string& version);

}  // namespace app
