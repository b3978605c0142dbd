#pragma once

#include <string>
#include <vector>

#include "bio/tables/recording.h"

/// Shared parts of the readers of the recording formats.
namespace bio {

/// Notes of a reader beside the numbers.
struct ReadingNotes {
  std::vector<std::string> remarks;   ///< what was left out or assumed
  std::vector<std::string> warnings;  ///< contradictions, and what was resampled
};

/// One column as it stands in the file.
struct RawColumn {
  int number = 0;      ///< counted from 1
  std::string header;  ///< empty: none
  std::string unit;    ///< empty: the file does not say
  double rate = 0;     ///< [Hz]; 0: the file does not say
  double startTime = 0;
  Eigen::VectorXd values;  ///< NaN: empty cell; empty cells at the end are cut off
  double nominalRate = 0;  ///< as Channel::nominalRate
  double largestGap = 0;   ///< as Channel::largestGap
};

/// The lines of a text file without their line ends. @throws FileError
std::vector<std::string> linesOf(const std::string& file);

/// The cells of a line, trimmed; the separator ' ' stands for any run of white space.
std::vector<std::string> cellsOf(const std::string& line, char separator);

/// The number in a cell of a named column. @throws FileError unless it is a finite number, all of
/// it
double finiteNumber(const std::string& file, std::size_t line, const std::string& column,
                    const std::string& cell);

/// The project's word for a unit that is known (units.h), whatever the instrument writes: µV and
/// microvolts are uV, ° is deg; any other as it is.
std::string plainUnit(std::string unit);

/// The unit that a column's name states: "BIClong_uV" uV, "speed_deg_s" deg/s, "biceps [mV]" mV,
/// "knee (deg)" deg; empty: none.
std::string unitInName(const std::string& column);

/// Takes away values at both ends that are not measured.
void cutEnds(Channel& channel);

/// Is this a number, all of it?
bool isNumber(const std::string& cell);

/// Columns of numbers from line `firstLine` (counted from 1) to the end of the file.
/// @throws FileError for a cell that is neither empty nor a finite number
std::vector<RawColumn> numberColumns(const std::string& file, const std::vector<std::string>& lines,
                                     std::size_t firstLine, char separator);

/// A column of a table at `rate`. Only every k-th row filled: a signal of rate/k. Empty rows at the
/// ends are cut off.
RawColumn compressed(const Eigen::VectorXd& cells, double rate, double startTime);

/// The line of names, counted from 1, of an EMGworks or a Noraxon export; 0: it is none.
std::size_t emgworksNames(const std::vector<std::string>& lines);
std::size_t noraxonNames(const std::vector<std::string>& lines);

/// The line of rates, counted from 1, of a Trigno Discover export; 0: it is none.
std::size_t discoverRates(const std::vector<std::string>& lines);
/// Whether the lines are a Vicon Nexus export.
bool isNexus(const std::vector<std::string>& lines);
/// The line of names, counted from 1, of a listing; 0: it is none, or a plain table.
std::size_t listingNames(const std::vector<std::string>& lines);

/// Reads one format each; remarks say what was left out.
std::vector<RawColumn> readC3dColumns(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readTrcColumns(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readXdfColumns(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readPlainColumns(const std::string& file);
std::vector<RawColumn> readTrigno(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readEmgworks(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readNoraxon(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readTableColumns(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readNexus(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readListing(const std::string& file, ReadingNotes& notes);
std::vector<RawColumn> readEdfColumns(const std::string& file, ReadingNotes& notes);
/// Delsys Trigno Discover's export, which readTrigno() also reads.
std::vector<RawColumn> readDiscover(const std::string& file, const std::vector<std::string>& lines,
                                    ReadingNotes& notes);

}  // namespace bio
