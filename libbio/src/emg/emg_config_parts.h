#pragma once

#include "bio/emg/emg_config.h"
#include "tables/toml_table.h"

/// Parts of the configuration of `fisherhill emg`; not public.
namespace bio {

/// [[unrecorded]]
void readUnrecorded(TomlTable& root, EmgConfigFile& out);
/// [markers]
void readMarkers(TomlTable& root, EmgConfigFile& out);

/// Columns of the markers that the recording has, behind the others.
/// @throws FileError
void addMarkerColumns(const EmgConfigFile& config, const Recording& recording,
                      const std::vector<std::string>& markers, EmgConfig& out);

}  // namespace bio
