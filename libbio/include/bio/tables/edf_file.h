#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bio/tables/recording.h"

namespace bio {

/// Contents of an EDF, EDF+ or BDF file.
struct EdfFile {
  std::vector<Channel> channels;      ///< by their labels, which need not be unique
  std::vector<std::string> remarks;   ///< what was left out
  std::vector<std::string> warnings;  ///< where the header contradicts the data
};

/// Reads the signals of an EDF or EDF+ (16 bits) or BDF (24 bits) file. A number d of the file is
///     physical minimum + (d − digital minimum)·(physical range)/(digital range)
/// in the signal's unit. Times begin with the first record; the gaps of an interrupted recording
/// (EDF+D, BDF+D) are NaN, from the time stamps of its records. Annotations are left out. Source:
/// Kemp et al. 1992, Electroenceph Clin Neurophysiol 82, 391; Kemp & Olivan 2003, Clin Neurophysiol
/// 114, 1755 (edfplus.info); biosemi.com for BDF.
/// @throws FileError for a file that is none, a header with what is no number, equal minima and
///   maxima, records that hold nothing
EdfFile readEdf(const std::filesystem::path& file);

/// Contents of such a file from bytes in memory, which messages call `name`.
EdfFile edfFrom(std::string_view bytes, const std::string& name);

namespace tables {
/// Is this an EDF or BDF file, by its first bytes?
bool isEdf(std::string_view bytes);
}  // namespace tables

}  // namespace bio
