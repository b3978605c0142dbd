#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "bio/tables/units.h"
#include "tables/cells.h"
#include "tables/equal_times.h"
#include "tables/recording_layouts.h"

namespace bio {

namespace {

// An angle of OpenSim, whose unit the header tells: all coordinates but those that translate.
bool isAngleInDegrees(const Table& table, const std::string& column) {
  return table.inDegrees && !column.ends_with("_tx") && !column.ends_with("_ty") &&
         !column.ends_with("_tz");
}

}  // namespace

std::string unitInName(const std::string& column) {
  constexpr std::array<std::string_view, 17> units = {
      "V",    "mV",     "uV",     "deg", "rad", "mrad", "g",     "N m",  "N mm",
      "N cm", "ft lbf", "in lbf", "mm",  "cm",  "lbf",  "deg/s", "rad/s"};
  const char last = column.empty() ? ' ' : column.back();
  if (last == ']' || last == ')') {
    const auto open = column.rfind(last == ']' ? '[' : '(');
    if (open == std::string::npos || open == 0) return "";
    const std::string unit = column.substr(open + 1, column.size() - open - 2);
    // "knee (right)", "EMG (2)" are no units; what brackets hold is one, known or not
    const bool isWord =
        last == ')' && !knownUnit(unit) &&
        (unit.find(' ') != std::string::npos || isNumber(unit) ||
         std::string_view(",l,r,left,right,raw,filtered,abs,x,y,z,")
                 .find("," + tables::lowered(unit) + ",") != std::string_view::npos);
    return isWord ? "" : unit;
  }
  // "BIClong_uV", "speed_deg_s"
  auto mark = column.rfind('_');
  if (mark == std::string::npos) return "";
  std::string unit = column.substr(mark + 1);
  if (unit == "s" && mark > 0 && column.rfind('_', mark - 1) != std::string::npos) {
    mark = column.rfind('_', mark - 1);
    unit = column.substr(mark + 1, column.size() - mark - 3) + "/s";
  }
  const std::string plain = plainUnit(unit);
  return std::find(units.begin(), units.end(), plain) != units.end() ? unit : "";
}

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

std::vector<RawColumn> readTableColumns(const std::string& file, ReadingNotes& notes) {
  const Table table = readTable(file);
  const RowTimes rows = rowTimesOf(file, timesOf(table));
  if (!rows.equal) notes.warnings.push_back(jitterOf(rows));
  std::vector<RawColumn> out;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const std::string& name = table.columns[k];
    if (name == "time" || name == "time_s") continue;
    RawColumn column = atEqualTimes(table.values.col(static_cast<Eigen::Index>(k)), rows);
    column.number = static_cast<int>(k + 1);
    column.header = name;
    column.unit = unitInName(name);
    if (column.unit.empty() && isAngleInDegrees(table, name)) column.unit = "deg";
    out.push_back(std::move(column));
  }
  return out;
}

}  // namespace bio
