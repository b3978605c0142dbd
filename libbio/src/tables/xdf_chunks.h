#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tables/bytes.h"

namespace bio::tables {

/// A stream as its chunks hold it.
struct RawXdfStream {
  std::string name, type;
  std::size_t channels = 0;
  double nominalRate = 0;  ///< [Hz]; 0: irregular
  std::size_t width = 0;   ///< bytes of a value; 0: texts
  bool floats = false;
  std::vector<std::string> labels, units;          ///< of the channels; can be fewer
  std::vector<double> stamps;                      ///< [s], one per sample
  std::vector<double> values;                      ///< sample after sample
  std::vector<std::pair<double, double>> offsets;  ///< of the clock: at [s], by [s]
};

struct RawXdf {
  std::vector<RawXdfStream> streams;  ///< in the order of their headers
  std::size_t unread = 0;             ///< bytes behind the last complete chunk
};

bool isXdf(std::string_view bytes);

/// Reads all chunks of a file. @throws FileError as readXdf
RawXdf readXdfChunks(const Bytes& bytes);

}  // namespace bio::tables
