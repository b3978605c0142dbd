#include "bio/analysis/coordinate_curve.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/analysis/replay.h"
#include "bio/model/units.h"
#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"

namespace bio {

CoordinateCurve readCoordinate(const std::filesystem::path& statesFile,
                               const Coordinate& coordinate) {
  const Table table = readTable(statesFile);
  const std::string& name = coordinate.name;
  std::string found;
  for (const std::string& column : table.columns) {
    const bool matches = column == name || column == name + "_deg" || column == name + "_rad" ||
                         column == name + "/value" || column.ends_with("/" + name + "/value");
    if (!matches) continue;
    if (!found.empty()) {
      throw FileError(fmt::format("{}: columns '{}' and '{}' both hold coordinate '{}'",
                                  statesFile.string(), found, column, name));
    }
    found = column;
  }
  if (found.empty()) {
    throw FileError(
        fmt::format("{}: no column of coordinate '{}' (/jointset/…/{}/value, {}, {}_deg or {}_rad)",
                    statesFile.string(), name, name, name, name, name));
  }
  const bool degrees = coordinate.isRotation &&
                       ((table.inDegrees && found != name + "_rad") || found == name + "_deg");
  const Eigen::VectorXd times = timesOf(table);
  const Eigen::VectorXd values =
      table.values.col(columnIndex(table, found)) * (degrees ? radiansPerDegree : 1.0);
  return {{times.begin(), times.end()}, {values.begin(), values.end()}};
}

double rmsDifference(const MusculoskeletalSystem& arm, const CoordinateCurve& curve,
                     const Trajectory& motion, const std::string& coordinate) {
  MeasuredChannel known{ofCoordinate(coordinate), {}, {}};
  std::vector<double> times, values;
  for (std::size_t i = 0; i < curve.time.size(); ++i) {
    if (std::isnan(curve.value[i])) continue;
    times.push_back(curve.time[i]);
    values.push_back(curve.value[i]);
  }
  const auto n = static_cast<Eigen::Index>(times.size());
  known.times = Eigen::Map<const Eigen::VectorXd>(times.data(), n);
  known.values = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
  return compareWithMeasured(arm, motion, known).rms;
}

}  // namespace bio
