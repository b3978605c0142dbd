#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bio/simulation/simulate.h"

namespace bio {

/// The course of one coordinate in a result of any program.
struct CoordinateCurve {
  std::vector<double> time;   ///< [s] rising
  std::vector<double> value;  ///< [rad] or [m]; NaN where the table has no value
};

/// Reads a table of states or kinematics: the column `/jointset/JOINT/NAME/value` of OpenSim 4,
/// `JOINT/NAME/value` or `NAME` of OpenSim 3, `NAME_deg` or `NAME_rad`. Angles are degrees when the
/// name ends in `_deg`, or the header says inDegrees=yes and the name does not end in `_rad`.
/// @throws FileError if the table cannot be read or has no such column, or more than one
CoordinateCurve readCoordinate(const std::filesystem::path& statesFile,
                               const Coordinate& coordinate);

/// RMS of curve − motion at those times of the curve that the motion covers [rad] or [m].
/// @throws std::invalid_argument if it covers none of them, or the coordinate is not free
double rmsDifference(const MusculoskeletalSystem& arm, const CoordinateCurve& curve,
                     const Trajectory& motion, const std::string& coordinate);

}  // namespace bio
