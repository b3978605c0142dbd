#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "discover/model_discovery.h"
#include "ensemble/worker_pool.h"

namespace app {

/// `fisherhill ensemble MODEL --discover FOLDER`: runs `discover` on many data sets. Each subfolder
/// with files train_*.sto, and possibly held_out*.sto, is a data set. The files of `discover` are
/// in verdicts/NAME, and verdicts.csv has one row per set; a set that has its row is skipped.
/// @param each the model and the options for all sets; its trials are ignored
/// @throws std::exception for bad input, Interrupted after Ctrl-C
ExitStatus discoverInSets(ModelDiscoveryRequest each, const std::filesystem::path& folder,
                          const CommandContext& context, WorkerPool& pool, int threads);

}  // namespace app
