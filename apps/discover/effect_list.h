#pragma once

#include "options/simulation_options.h"
#include "output/command_context.h"

/// `fisherhill discover --list-effects MODEL`.
namespace app {

/// Prints a line for every effect that `discover` looks for in the model: id, name, kind, and its
/// parameters with units; with --json also the long name of the id, the sentence, and the effects
/// that the same data never tell from it. Effects that the model already has come last.
/// @throws std::invalid_argument, bio::FileError for bad input
ExitStatus listEffects(const CommandContext& context, const std::string& model,
                       SimulationOptions simulation);

}  // namespace app
