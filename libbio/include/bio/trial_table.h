#pragma once

#include <string>

#include "bio/table_file.h"
#include "bio/trial.h"

namespace bio {

/// The trial that readTrial makes of a file, from columns that are in memory already.
/// @param name  stands for the file in messages, and in Trial::file
/// @throws FileError as readTrial, and for times that are not finite or do not rise
Trial trialFrom(const Table& table, const std::string& name, const Model& model,
                const TrialOptions& options = {});

}  // namespace bio
