#pragma once

#include <string>
#include <vector>

#include "output/output_folder.h"
#include "output/summary.h"

/// Rules for commands with calibration and held-out trials.
namespace app {

/// bio::requireDifferentTrials() for the inputs of a command.
/// @param summary its inputs are the model, the calibration trials, the held-out trials
/// @param training number of calibration trials
/// @param first index of the first trial among the inputs
/// @throws std::invalid_argument naming both files
void inputsMustDiffer(const Summary& summary, std::size_t training, std::size_t first = 1);

/// No result may overwrite an input, even with --force.
/// @param results  names of the files to be written
/// @throws std::invalid_argument naming the input
void resultsMustNotBeInputs(const Summary& summary, const OutputFolder& folder,
                            const std::vector<std::string>& results);

}  // namespace app
