#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bio/tables/recording.h"

namespace bio {

/// One numeric stream of an XDF file at its effective rate.
struct XdfStream {
  std::string name, type;
  std::vector<Channel> channels;  ///< named by stream and label, "EMG biceps"
};

struct XdfFile {
  std::vector<XdfStream> streams;     ///< those with numbers at a steady rate
  std::vector<std::string> remarks;   ///< what was left out or looks odd
  std::vector<std::string> warnings;  ///< stamps that run backwards, rates that contradict
};

/// Reads the numeric streams of an XDF file, as Lab Streaming Layer's recorders write it. All are
/// brought to one clock: to each stamp t of a stream the straight line through its measured clock
/// offsets is added, by parts where they leap by 1 s or more, because its clock was set or its
/// computer restarted; a single offset that the ones before and behind it contradict is scatter. A
/// stream's start and effective rate are those of the straight line through its stamps over their
/// numbers; a sample without a stamp follows the one before by 1/nominal_srate. Where stamps leap
/// by more than max(1 s, 500 samples), samples are missing: NaN. Times begin at the earliest sample
/// of all streams. Streams of texts and streams without a rate (events) are left out, and so are
/// samples behind the point where a recording was cut off. Source: XDF 1.0 specification
/// (github.com/sccn/xdf).
/// @throws FileError for a file that is no XDF, a chunk whose length or content does not fit, a
///   stream without a header, stamps that go back
XdfFile readXdf(const std::filesystem::path& file);

/// Contents of an XDF file from bytes in memory, which messages call `name`.
XdfFile xdfFrom(std::string_view bytes, const std::string& name);

}  // namespace bio
