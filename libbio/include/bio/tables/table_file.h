#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bio {

/// A rectangular table of numbers with named columns. NaN: not measured.
struct Table {
  std::string name;                             ///< first line of a .sto/.mot header
  bool inDegrees = false;                       ///< angles are degrees (header inDegrees=yes)
  std::map<std::string, std::string> metadata;  ///< other key=value lines of the header
  std::vector<std::string> columns;             ///< unique
  Eigen::MatrixXd values;                       ///< one row per row, one column per column
};

enum class TableKind {
  any,        ///< any columns, at least one row
  timeSeries  ///< has a column of times: every cell finite, strictly rising
};

/// Reads .sto or .mot (header up to `endheader`, then a row of names; cells between tabs or
/// spaces), .csv (a row of names; commas, semicolons or tabs) or, with any other extension, the
/// format suggested by the first line. Empty cells and NaN become NaN. nRows, nColumns, datarows,
/// datacolumns in a header are checked. As laboratories and spreadsheets write tables: byte order
/// marks, quotes, a first line `sep=;`, decimal commas between semicolons or tabs, and empty rows
/// and columns at the end. In a time series without a column `time` or `time_s`, the one called
/// `Time`, `time [ms]`, `TIME_ms`, `time (s)` … becomes `time` in seconds.
/// @throws FileError naming file, line and column
Table readTable(const std::filesystem::path& file, TableKind kind = TableKind::timeSeries);

/// Writes .csv if the file has this extension, else .sto as OpenSim 4 does; every number reads back
/// as the same double. The file appears complete or not at all.
/// @throws FileError if it cannot be written, or if a cell is infinite, or names and values do not
///   match
void writeTable(const Table& table, const std::filesystem::path& file);

bool hasColumn(const Table& table, const std::string& column);

/// The index of the column in Table::columns.
/// @throws std::invalid_argument with a list of the existing columns
Eigen::Index columnIndex(const Table& table, const std::string& column);

/// The column `time` or `time_s` [s].
/// @throws std::invalid_argument if there is none
Eigen::VectorXd timesOf(const Table& table);

}  // namespace bio
