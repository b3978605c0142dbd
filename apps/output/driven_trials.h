#pragma once

#include <string>

#include "bio/analysis/driven_trial.h"
#include "output/output_folder.h"

namespace app {

/// "driven_1.sto", or "driven_held_out_1.sto".
/// @param number  of the trial among the fitted or the held-out ones, from 1
std::string drivenName(std::size_t number, bool heldOut);

/// Writes FittedTrial::driven and adds the trial's starts to the model.
/// @return the file to replay: its path in the folder, or its name if there is no folder
std::string writeDriven(const bio::FittedTrial& trial, std::size_t number, bio::Model& model,
                        OutputFolder& folder);

}  // namespace app
