#pragma once

#include <CLI/CLI.hpp>

#include "bio/simulation/musculoskeletal_system.h"
#include "output/command_context.h"

/// --list-parameters, for commands that take parameter names; it requires no trial.
namespace app {

void addListParameters(CLI::App& options, bool& list);

/// Prints every parameter of the model, its name, value, unit and meaning; with --json also its
/// bounds.
ExitStatus listParameters(const CommandContext& context, const bio::Model& model,
                          const bio::MusculoskeletalSystem& system);

}  // namespace app
