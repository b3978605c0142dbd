#pragma once

#include <CLI/CLI.hpp>

#include "output/command_context.h"

namespace app {

/// Adds --out, --figures, --force, --json, --seed and --threads to a subcommand.
void addCommonOptions(CLI::App& subcommand, CommandContext& context);

}  // namespace app
