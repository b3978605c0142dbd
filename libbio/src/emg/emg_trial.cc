#include "bio/emg/emg_trial.h"

#include <fmt/format.h>

#include "bio/opensim/osim_file.h"
#include "bio/tables/file_error.h"

namespace bio {

std::vector<std::string> markerNames(const EmgConfigFile& config) {
  std::vector<std::string> names;
  if (!config.markers || config.markers->model.empty()) return names;
  try {
    for (const Marker& marker : readOsim(config.markers->model).markers) {
      names.push_back(marker.body + "." + marker.name);
    }
  } catch (const std::exception& error) {
    throw FileError(
        fmt::format("{}:{}: [markers] model: {}", config.file, config.markers->line, error.what()));
  }
  return names;
}

Table excitationTable(const EmgResult& result, const EmgConfig& config) {
  Table table;
  table.name = "excitations";
  table.columns = {"time"};
  table.columns.insert(table.columns.end(), result.muscles.begin(), result.muscles.end());
  const Eigen::Index muscles = result.excitations.cols();
  table.values.resize(result.time.size(),
                      1 + muscles + (result.measured ? 1 : 0) + result.columns.cols());
  table.values.col(0) = result.time;
  table.values.middleCols(1, muscles) = result.excitations;
  if (result.measured) {
    table.columns.push_back(result.measured->coordinate + "_deg");
    table.values.col(1 + muscles) = result.measured_deg;
  }
  for (const MeasuredOptions& column : config.columns) table.columns.push_back(column.coordinate);
  table.values.rightCols(result.columns.cols()) = result.columns;
  std::vector<LatentDeclaration> latent;
  for (const UnrecordedMuscle& muscle : config.unrecorded) {
    if (muscle.latent) latent.push_back(*muscle.latent);
  }
  if (!latent.empty()) table.metadata["latent_excitation"] = latentHeader(latent);
  return table;
}

}  // namespace bio
