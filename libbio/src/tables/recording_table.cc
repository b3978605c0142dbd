#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "bio/tables/units.h"
#include "tables/recording_layouts.h"

namespace bio {

// Printed times are rounded, so single intervals may differ; a missing or doubled
// row moves all that follow by a whole interval against equal spacing between the first and the
// last.
double rateOf(const std::string& file, const Eigen::VectorXd& times) {
  const Eigen::Index last = times.size() - 1;
  if (last < 1) {
    throw FileError(fmt::format("{}: has {} rows, a recording needs at least 2", file, last + 1));
  }
  const double rate = static_cast<double>(last) / (times[last] - times[0]);
  for (Eigen::Index i = 0; i <= last; ++i) {
    const double off = (times[i] - times[0]) * rate - static_cast<double>(i);
    if (!(std::abs(off) <= 0.25)) {
      throw FileError(
          fmt::format("{}: time = {} s in row {} is {:.2g} intervals away from equal spacing at "
                      "{:.6g} Hz, must be "
                      "at most 0.25",
                      file, times[i], i + 1, std::abs(off), rate));
    }
  }
  // a rate read off rounded times is known only so well
  const double rounded = std::round(rate);
  return std::abs(rounded / rate - 1) < 1e-4 ? rounded : rate;
}

namespace {

// "BIClong_uV" → "uV", "envelope_mV" → "mV", "biceps [mV]" → "mV", "knee (deg)" → "deg"
std::string unitIn(const std::string& column) {
  constexpr std::array<std::string_view, 9> units = {"V", "mV",  "uV", "deg", "rad",
                                                     "g", "N m", "mm", "cm"};
  const char last = column.empty() ? ' ' : column.back();
  if (last == ']' || last == ')') {
    const auto open = column.rfind(last == ']' ? '[' : '(');
    if (open == std::string::npos || open == 0) return "";
    return plainUnit(column.substr(open + 1, column.size() - open - 2));
  }
  const auto mark = column.rfind('_');
  if (mark == std::string::npos) return "";
  const std::string unit = plainUnit(column.substr(mark + 1));
  return std::find(units.begin(), units.end(), unit) != units.end() ? unit : "";
}

// An angle of OpenSim, whose unit the header tells: all coordinates but those that translate.
bool isAngleInDegrees(const Table& table, const std::string& column) {
  return table.inDegrees && !column.ends_with("_tx") && !column.ends_with("_ty") &&
         !column.ends_with("_tz");
}

}  // namespace

RawColumn compressed(const Eigen::VectorXd& cells, double rate, double startTime) {
  Eigen::Index first = -1;
  Eigen::Index last = -1;
  Eigen::Index stride = 0;
  for (Eigen::Index i = 0; i < cells.size(); ++i) {
    if (std::isnan(cells[i])) continue;
    if (first < 0) first = i;
    stride = std::gcd(stride, i - first);
    last = i;
  }
  RawColumn out;
  if (first < 0) return out;
  stride = std::max<Eigen::Index>(stride, 1);
  out.rate = rate / static_cast<double>(stride);
  out.startTime = startTime + static_cast<double>(first) / rate;
  out.values = cells(Eigen::seq(first, last, stride));
  return out;
}

std::string plainUnit(std::string unit) {
  const auto known = knownUnit(unit);
  return known ? std::string(known->name) : unit;
}

std::vector<RawColumn> readTableColumns(const std::string& file) {
  const Table table = readTable(file);
  const Eigen::VectorXd times = timesOf(table);
  const double rate = rateOf(file, times);
  std::vector<RawColumn> out;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const std::string& name = table.columns[k];
    if (name == "time" || name == "time_s") continue;
    RawColumn column = compressed(table.values.col(static_cast<Eigen::Index>(k)), rate, times[0]);
    column.number = static_cast<int>(k + 1);
    column.header = name;
    column.unit = unitIn(name);
    if (column.unit.empty() && isAngleInDegrees(table, name)) column.unit = "deg";
    out.push_back(std::move(column));
  }
  return out;
}

}  // namespace bio
