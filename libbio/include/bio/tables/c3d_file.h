#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bio/tables/marker_trajectories.h"
#include "bio/tables/recording.h"

namespace bio {

/// Contents of a C3D file.
struct C3dFile {
  MarkerTrajectories markers;         ///< no columns if it has none
  std::vector<Channel> analog;        ///< in the units of ANALOG:UNITS; names need not be unique
  std::vector<std::string> remarks;   ///< what was left out or assumed
  std::vector<std::string> warnings;  ///< contradictions
};

/// Reads points and analog channels of a C3D file with numbers as Intel, DEC or MIPS processors
/// write them, as integers or floats:
///     position = POINT:SCALE·integer (or the float itself), in POINT:UNITS
///     analog = (number − ANALOG:OFFSET)·ANALOG:SCALE·ANALOG:GEN_SCALE
/// Frame k is at (k − 1)/POINT:RATE. A point with a residual below 0 is not seen. More than 65535
/// frames are counted by TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD or POINT:LONG_FRAMES; more
/// than 255 names stand in LABELS2, LABELS3, … Points that POINT:ANGLES, FORCES, MOMENTS, POWERS or
/// SCALARS name are no positions and are left out. Source: The C3D File Format, user guide (Motion
/// Lab Systems, c3d.org).
/// @throws FileError for a file that is no C3D, is cut off, or contradicts itself in what decides
///   how its numbers are read
C3dFile readC3d(const std::filesystem::path& file);

/// Contents of a C3D file from bytes in memory, which messages call `name`.
C3dFile c3dFrom(std::string_view bytes, const std::string& name);

}  // namespace bio
