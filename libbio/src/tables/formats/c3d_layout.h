#pragma once

#include <cstddef>

#include "tables/formats/bytes.h"
#include "tables/formats/c3d_parameters.h"
#include "tables/recording_layouts.h"

namespace bio::tables {

inline constexpr std::size_t c3dBlock = 512;

/// Layout of the data section of a C3D file.
struct C3dLayout {
  std::size_t points = 0;
  std::size_t channels = 0;
  std::size_t samplesPerFrame = 0;
  std::size_t frames = 0;
  double firstFrame = 1;  ///< counted from 1
  double rate = 0;        ///< of frames [Hz]
  double scale = 1;       ///< of points; < 0: floats
  std::size_t data = 0;   ///< where it begins [byte]

  bool floats() const { return scale < 0; }
  std::size_t width() const { return floats() ? 4 : 2; }
  std::size_t valuesPerFrame() const { return 4 * points + channels * samplesPerFrame; }
};

/// From header and parameters; notes tell where they contradict each other and what was used.
/// @throws FileError where they contradict each other in what nothing else decides, or promise more
///   than the file holds
C3dLayout c3dLayoutOf(const Bytes& bytes, const C3dParameters& parameters, ReadingNotes& notes);

}  // namespace bio::tables
