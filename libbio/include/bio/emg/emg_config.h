#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/emg/emg.h"
#include "bio/tables/recording.h"

namespace bio {

/// Normalisation as given in the file.
struct FullDeclaration {
  std::optional<double> mvc;  ///< of the envelope, in `unit`
  std::string unit;           ///< of mvc
  std::string mvcFile;        ///< recording of a maximum contraction, path as it can be opened
  std::optional<double> percentile;  ///< of this recording's own envelope
};

/// A recording behind the first: another file of the same movement, perhaps with another clock.
struct FurtherRecording {
  RecordingLayout layout;
  std::optional<double> offset;  ///< time of the first = its own + offset [s]; absent: found by …
  std::string match, with;       ///< … its channel `match` and an earlier recording's `with`
  std::optional<double> within;  ///< |offset| looked for [s]
  int line = 0;
};

/// How points of a C3D or TRC file become columns of markers.
struct MarkerDeclaration {
  std::string model;  ///< its markers are looked for; path as it can be opened
  std::map<std::string, std::string> names;  ///< BODY.MARKER, or with a model MARKER, by the
                                             ///< file's name; empty: all of the model's names
  struct Axis {
    int laboratory;  ///< 0 x, 1 y, 2 z
    double sign;     ///< +1 or −1
  };
  std::array<Axis, 3> axes = {{{0, 1}, {1, 1}, {2, 1}}};  ///< of the model's x, y, z
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();       ///< the model's, in the laboratory [m]
  std::optional<double> lowPass;                          ///< [Hz]
  int line = 0;
};

/// A configuration of `fisherhill emg` as read from its TOML file; docs/emg.md lists every key.
struct EmgConfigFile {
  std::string file;
  RecordingLayout layout;
  std::vector<FurtherRecording> further;
  EmgConfig emg;                         ///< without the settings that depend on the recording
  std::vector<FullDeclaration> full;     ///< one per electrode
  std::vector<int> electrodeLines;       ///< line of each electrode in the file
  std::optional<double> degreesPerUnit;  ///< of the measured channel, if stated
  int measuredLine = 0;                  ///< of [measured], 0: none
  std::vector<int> columnLines;          ///< of [[column]]
  std::vector<bool> columnScales;        ///< whether it has a scale or an offset of its own
  std::optional<MarkerDeclaration> markers;
};

/// @throws FileError "file:line: key = value, rule" for TOML that cannot be parsed, an unknown key,
/// a value of the wrong type or out of its range, a missing key
EmgConfigFile readEmgConfig(const std::string& file);

/// The configuration for one recording: channels found, maximum contractions read from their own
/// files (the maximum of their envelope through the same filters) or converted to the unit of their
/// channel, measured columns converted from the unit that the file states to that of a trial
/// (EmgConfig::conversions), unless they have a scale.
/// A marker of the model becomes three columns BODY.MARKER.x, .y and .z of points in the recording,
/// turned into the model's axes.
/// @param markers  BODY.MARKER of the model that [markers] names, if it does
/// @throws FileError "file:line: …" for a missing channel or marker or a unit that does not match
EmgConfig emgConfigFor(const EmgConfigFile& config, const Recording& recording,
                       const std::vector<std::string>& markers = {});

}  // namespace bio
