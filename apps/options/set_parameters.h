#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bio/parameters/with_parameters.h"
#include "options/simulation_options.h"
#include "output/summary.h"

/// --set, for commands that take a model.
namespace app {

/// Adds --set. addModelOptions() does for commands that have the other options of the model.
CLI::Option* addSetOption(CLI::App& subcommand, std::vector<Assignment>& set);

/// The model with the values of --set, which the summary and its methods tell; values of a trial
/// are left to the caller.
/// @throws std::invalid_argument what bio::withParameters throws, as the option's
bio::ModelWithParameters withSetParameters(bio::Model model, const bio::SystemOptions& options,
                                           const std::vector<Assignment>& set, Summary& summary);

/// bio::requireOfModel() as the option says it.
void refuseValuesOfTrial(const bio::ModelWithParameters& changed);

/// For commands that take the model as it then is.
/// @throws std::invalid_argument also for a value of a trial
bio::Model withSetParameters(bio::Model model, const SimulationOptions& options, Summary& summary);

/// For commands without a trial that would choose coordinates: those typed, else
/// bio::optionsOfWholeModel.
bio::Model withSetInWholeModel(bio::Model model, const SimulationOptions& options,
                               Summary& summary);

/// " --set NAME=VALUE …", as words of another command.
std::string setWords(const SimulationOptions& options);

}  // namespace app
