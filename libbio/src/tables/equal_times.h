#pragma once

#include <string>

#include "tables/recording_layouts.h"

namespace bio {

/// How the rows of a table lie in time.
struct RowTimes {
  Eigen::VectorXd times;  ///< [s]
  double rate = 0;        ///< [Hz]; of unequal times: one over the median interval
  bool equal = true;      ///< each row at most a quarter of an interval off
};

/// @throws FileError for fewer than two rows, times that do not rise, or gaps so long that a table
///   of equal spacing would have over four times the rows
RowTimes rowTimesOf(const std::string& file, const Eigen::VectorXd& times);

/// The sentence that a table of unequal times was resampled; empty for equal ones.
std::string jitterOf(const RowTimes& rows);

/// The column at equal spacing. Equal times: as compressed(). Unequal ones: straight between its
/// samples at one over their median interval; NaN within gaps of over 2.5 intervals.
RawColumn atEqualTimes(const Eigen::VectorXd& cells, const RowTimes& rows);

}  // namespace bio
