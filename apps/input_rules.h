#pragma once

#include <string>
#include <vector>

#include "output_folder.h"
#include "summary.h"

/// Rules for commands that estimate from some trials and judge by others.
namespace app {

/// A trial that is estimated from twice counts twice, and one held out must not be estimated from.
/// @param summary   its inputs are the model, the trials that are estimated from, those held out
/// @param training  how many are estimated from
/// @param first     place of the first trial: how many inputs there are before
/// @throws std::invalid_argument naming both files
void inputsMustDiffer(const Summary& summary, std::size_t training, std::size_t first = 1);

/// No result may take an input's place, not even with --force.
/// @param results  names of the files to be written
/// @throws std::invalid_argument naming the input
void resultsMustNotBeInputs(const Summary& summary, const OutputFolder& folder,
                            const std::vector<std::string>& results);

}  // namespace app
