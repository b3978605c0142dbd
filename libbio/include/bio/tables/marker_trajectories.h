#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bio {

/// Positions of markers as a motion capture system recorded them, in its laboratory frame.
struct MarkerTrajectories {
  std::string file;
  double rate = 0;                 ///< frames per second [Hz] > 0
  Eigen::VectorXd times;           ///< of the frames [s], equally spaced
  std::vector<std::string> names;  ///< unique
  /// [m], one row per frame: x, y, z of the first marker, of the second, …; NaN: not seen
  Eigen::MatrixXd positions;
  std::vector<std::string> remarks;  ///< what was left out or assumed
};

/// Reads the markers of a C3D or a TRC file (by its content, whatever it is called).
/// @throws FileError as readC3d and readTrc, and for a file that is neither
MarkerTrajectories readMarkers(const std::filesystem::path& file);

/// Reads a TRC file by the order of its cells, between tabs, commas or blanks: `PathFileType` in line
/// 1, keys and values of DataRate and Units (mm, cm or m) in lines 2 and 3, names of markers in line
/// 4, perhaps labels `X1 Y1 Z1 …`, then rows of frame, time and three coordinates of each marker.
/// Empty cells and NaN: not seen; the last cells of a row can be missing. Remarks tell where counts
/// of frames and markers, DataRate or names contradict the rows, and what was taken.
/// @throws FileError naming line and cell for a value that is no number, no or unknown Units, more or
///   fewer names than columns where their places do not tell, times that fit no equal spacing (a
///   frame more than a quarter of an interval off; frames that are missing are not seen)
MarkerTrajectories readTrc(const std::filesystem::path& file);

/// Marker trajectories of a TRC text in memory, which messages call `name`.
MarkerTrajectories trcFrom(std::string_view text, const std::string& name);

/// The columns x, y, z of a marker.
/// @throws std::invalid_argument with a list of the existing names
Eigen::MatrixX3d positionsOf(const MarkerTrajectories& markers, const std::string& name);

}  // namespace bio
