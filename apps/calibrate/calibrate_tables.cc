#include "calibrate/calibrate_tables.h"

#include <fmt/format.h>

#include "calibrate/latent_excitations.h"
#include "output/text.h"

namespace app {

Table correlationTable(const CalibrateFindings& f) {
  Table table{"Correlations of the estimates", {""}, {}};
  std::vector<bio::CalibratedParameter> parameters;
  std::vector<Eigen::Index> place;
  for (std::size_t i = 0; i < f.calibration.parameters.size(); ++i) {
    if (bio::isKnot(f.calibration.parameters[i].target)) continue;
    parameters.push_back(f.calibration.parameters[i]);
    place.push_back(static_cast<Eigen::Index>(i));
  }
  for (const auto& parameter : parameters) table.columns.push_back(parameter.asked.name);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::vector<std::string> row = {parameters[i].asked.name};
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      row.push_back(parameters[i].atBound || parameters[j].atBound
                        ? "–"
                        : fmt::format("{:.3f}", f.calibration.correlation(place[i], place[j])));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table startTable(const CalibrateFindings& f) {
  Table table{"Starts", {"start", "cost [nats]", "ended"}, {}};
  for (std::size_t i = 0; i < f.calibration.starts.size(); ++i) {
    const info::StartOutcome& outcome = f.calibration.starts[i];
    table.rows.push_back(
        {i == 0 ? "model" : fmt::format("{}", i + 1), numberText(outcome.cost, 7), outcome.why});
  }
  return table;
}

}  // namespace app
