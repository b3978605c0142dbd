#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "arm_discovery.h"
#include "crew.h"

namespace app {

/// `fisherhill ensemble MODEL --discover FOLDER`: the same question asked of many data sets. Each
/// subfolder with files train_*.sto, and maybe held_out*.sto, is a set. What `discover` writes
/// stands in verdicts/NAME, one row per set in verdicts.csv; a set that has its row is not looked
/// at again.
/// @param each  the model and what holds for all sets; its trials are not looked at
/// @throws std::exception for bad input, Interrupted after Ctrl-C
ExitStatus discoverInSets(const ArmDiscoveryRequest& each, const std::filesystem::path& folder,
                          const CommandContext& context, Crew& crew, int threads);

}  // namespace app
