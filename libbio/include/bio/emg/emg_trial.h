#pragma once

#include <string>
#include <vector>

#include "bio/emg/emg.h"
#include "bio/emg/emg_config.h"
#include "bio/tables/table_file.h"

namespace bio {

/// BODY.MARKER of every marker of the model that [markers] names, for emgConfigFor(); empty
/// without.
/// @throws FileError, which names the configuration's line, if that model cannot be read
std::vector<std::string> markerNames(const EmgConfigFile& config);

/// The trial that a recording becomes: time [s], excitations by muscle, the measured coordinate
/// (`NAME_deg`), further measured columns in their own units; `latent_excitation` in the header
/// says which muscles without an electrode a calibration may correct.
Table excitationTable(const EmgResult& result, const EmgConfig& config);

}  // namespace bio
