#pragma once

#include <Eigen/Dense>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bio {

/// One recorded signal at its own rate: value k belongs to startTime + k/rate.
struct Channel {
  std::string name;
  std::string unit;              ///< of `values`; empty: not stated in the file
  double rate = 0;               ///< [Hz] > 0
  double startTime = 0;          ///< [s]
  Eigen::VectorXd values;        ///< NaN: not measured; first and last are measured
  std::string writtenUnit = {};  ///< as the file writes it
  double nominalRate = 0;        ///< as the device states it [Hz]; 0: it does not
  double largestGap = 0;  ///< between samples, where they were resampled [s]; 0: they were not
};

/// Time of the last sample [s].
double endTime(const Channel& channel);

/// File format of a recording.
///   columns  no header; numbers in columns of any length and rate, all starting in the first line;
///            names, rates and units come from the declaration
///   trigno   Delsys Trigno export: sensors in line 4, quantities with units in line 6, one rate
///            per column in line 7, columns of any length below; or Trigno Discover's, with times
///            in front of every signal (discover_export.cc)
///   emgworks Delsys EMGworks export: `X[s]` in front of every signal, each with times of its own,
///            which end when it ends; lines before the names are skipped
///   noraxon  Noraxon MR3 or MyoResearch export: a column of times, `NAME, UNIT`, columns of texts;
///            lines before the names are skipped
///   nexus    Vicon Nexus export: sections of devices and trajectories, each with a rate, names,
///            units, and rows of frame and sub frame
///   listing  text of a dynamometer (Biodex, Humac) and the like: lines, a row of names with one of
///            times, perhaps a row of units, rows of numbers between blanks, tabs, semicolons or
///            commas
///   table    .sto, .mot or .csv with a header row and a column of times (table_file.h)
///   edf      signals of an EDF, EDF+ or BDF file (edf_file.h)
///   c3d      analog channels of a C3D file, then its points (c3d_file.h)
///   xdf      numeric streams of an XDF file (xdf_file.h)
///   trc      points of a TRC file (marker_trajectories.h)
/// Points become channels NAME.x, NAME.y and NAME.z [m] in the laboratory's axes; those that were
/// never seen are left out.
enum class RecordingFormat {
  automatic,
  columns,
  trigno,
  table,
  c3d,
  xdf,
  trc,
  emgworks,
  noraxon,
  nexus,
  listing,
  edf
};

/// The name of the format as above.
std::string_view nameOf(RecordingFormat format);

/// Declaration of one column by the user; properties stated in the file need not be repeated.
struct ColumnDeclaration {
  int number = 0;               ///< counted from 1; 0: found by `header`
  std::string header;           ///< name as read from the file, used when number is 0
  std::string name;             ///< of the channel; empty: the name in the file
  std::string unit;             ///< after scaling; empty: the unit in the file
  std::optional<double> rate;   ///< [Hz] > 0; needed in the format `columns`
  std::optional<double> scale;  ///< value = scale·number + offset; absent: 1, not 0
  double offset = 0;            ///< in `unit`
};

struct RecordingLayout {
  RecordingFormat format = RecordingFormat::automatic;
  std::vector<ColumnDeclaration> columns;
};

struct Recording {
  std::string file;
  RecordingFormat format = RecordingFormat::automatic;  ///< as found, not automatic
  std::vector<Channel> channels;
  std::vector<std::string> remarks;   ///< data that was left out
  std::vector<std::string> warnings;  ///< where the file contradicts itself, or was resampled
};

/// `xdf`, `c3d` or `trc` by the first bytes (or the extension), `trigno` if line 7 is a row of
/// rates in Hz, `emgworks` or `noraxon` if a line of names is like theirs, `columns` if the first
/// line that is not empty contains only numbers, else `table`.
/// @throws FileError if the file cannot be read or is empty
RecordingFormat detectFormat(const std::string& file);

/// Reads the channels of a recording. Trigno channels are named by sensor and quantity ("bicep EMG
/// 1"), table channels by column; the unit of a table column is the text in brackets at the end of
/// its name, or after the last underscore if that is V, mV, uV, deg, rad or g; with inDegrees=yes
/// it is deg for any other that is no translation (_tx, _ty, _tz). C3D channels are named by
/// ANALOG:LABELS, XDF channels by stream and label ("EMG biceps"). A table column with values only
/// in every k-th row has the rate of the table divided by k.
/// @throws FileError "file:line: column …" for a cell that is not a number, a rate or unit that is
///   missing or contradicts the declaration, a value in a column that ended earlier (a gap must
///   have its separators), a missing declared column, a table whose times are not equally spaced (a
///   sample more than a quarter of an interval off)
Recording readRecording(const std::string& file, const RecordingLayout& layout = {});

/// The named channel, or throws std::invalid_argument with a list of the existing names.
const Channel& findChannel(const Recording& recording, const std::string& name);

}  // namespace bio
