#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tables/formats/bytes.h"

namespace bio::tables {

/// A measured offset of a stream's clock: time of the recorder = stamp + by.
struct XdfClockOffset {
  double at = 0, by = 0;    ///< [s]
  std::size_t samples = 0;  ///< of the stream that stand before it in the file
};

/// A stream as its chunks hold it.
struct RawXdfStream {
  std::string name, type;
  std::size_t channels = 0;
  double nominalRate = 0;  ///< [Hz]; 0: irregular
  std::size_t width = 0;   ///< bytes of a value; 0: texts
  bool floats = false;
  std::vector<std::string> labels, units;  ///< of the channels; can be fewer
  std::vector<double> stamps;              ///< [s], one per sample
  std::vector<double> values;              ///< sample after sample
  std::vector<XdfClockOffset> offsets;
  std::vector<std::size_t> restarts;  ///< samples at which its clock begins anew; once synchronised
};

struct RawXdf {
  std::vector<RawXdfStream> streams;  ///< in the order of their headers
  std::size_t unread = 0;             ///< bytes behind the last complete chunk
};

bool isXdf(std::string_view bytes);

/// Reads all chunks of a file. @throws FileError as readXdf
RawXdf readXdfChunks(const Bytes& bytes);

}  // namespace bio::tables
