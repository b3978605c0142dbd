#pragma once

#include <string>

#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"

namespace bio {

/// A trial from columns in memory, as readTrial makes it from a file.
/// @param name name used instead of a file in messages and in Trial::file
/// @throws FileError as readTrial, and for times that are not finite or do not rise
Trial trialFrom(const Table& table, const std::string& name, const Model& model,
                const TrialOptions& options = {});

}  // namespace bio
