#pragma once

#include <string>
#include <vector>

#include "bio/tables/recording.h"

/// What the readers of the recording formats share.
namespace bio {

/// One column as it stands in the file.
struct RawColumn {
  int number = 0;      ///< counted from 1
  std::string header;  ///< empty: none
  std::string unit;    ///< empty: the file does not say
  double rate = 0;     ///< [Hz]; 0: the file does not say
  double startTime = 0;
  Eigen::VectorXd values;  ///< NaN: empty cell; empty cells at the end are cut off
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

/// Takes away values at both ends that are not measured.
void cutEnds(Channel& channel);

/// Is this a number, all of it?
bool isNumber(const std::string& cell);

/// Columns of numbers from line `firstLine` (counted from 1) to the end of the file.
/// @throws FileError for a cell that is neither empty nor a finite number
std::vector<RawColumn> numberColumns(const std::string& file, const std::vector<std::string>& lines,
                                     std::size_t firstLine, char separator);

/// Rows per second at such times. @throws FileError unless they are equally spaced
double rateOf(const std::string& file, const Eigen::VectorXd& times);

/// A column of a table at `rate`. Only every k-th row filled: a signal of rate/k. Empty rows at the
/// ends are cut off.
RawColumn compressed(const Eigen::VectorXd& cells, double rate, double startTime);

/// The line of names, counted from 1, of an EMGworks or a Noraxon export; 0: it is none.
std::size_t emgworksNames(const std::vector<std::string>& lines);
std::size_t noraxonNames(const std::vector<std::string>& lines);

/// Reads one format each; remarks say what was left out.
std::vector<RawColumn> readC3dColumns(const std::string& file, std::vector<std::string>& remarks);
std::vector<RawColumn> readTrcColumns(const std::string& file, std::vector<std::string>& remarks);
std::vector<RawColumn> readXdfColumns(const std::string& file, std::vector<std::string>& remarks);
std::vector<RawColumn> readPlainColumns(const std::string& file);
std::vector<RawColumn> readTrigno(const std::string& file);
std::vector<RawColumn> readEmgworks(const std::string& file);
std::vector<RawColumn> readNoraxon(const std::string& file, std::vector<std::string>& remarks);
std::vector<RawColumn> readTableColumns(const std::string& file);

}  // namespace bio
