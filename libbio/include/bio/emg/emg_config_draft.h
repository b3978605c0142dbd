#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bio {

/// A configuration of `fisherhill emg` to begin with.
struct EmgConfigDraft {
  std::string text;       ///< TOML with comments
  int channels = 0;       ///< of all recordings, points of markers left out
  int electrodes = 0;     ///< channels in volts, or called EMG: each has a table [[electrode]]
  bool complete = false;  ///< readEmgConfig() takes it as it is; else comments say what is missing
};

/// Lists the channels of the recordings with units, rates and ranges, and writes a table for every
/// setting, with the defaults of docs/emg.md and a band below half the rates. The muscle of an
/// electrode is called as its channel without the unit. In a file without a header every column has
/// a declaration whose rate is left to the user.
/// @param recordings  files of one movement
/// @throws FileError for a file that cannot be read; std::invalid_argument for none
EmgConfigDraft draftEmgConfig(const std::vector<std::string>& recordings);

/// Writes the draft's text.
/// @throws FileError if there is such a file already, or it cannot be written
void writeEmgConfig(const EmgConfigDraft& draft, const std::filesystem::path& file);

}  // namespace bio
