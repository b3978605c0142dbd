#pragma once

#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "ensemble/ensemble_draws.h"
#include "report/report.h"

namespace app {

/// Sobol's indices of one output.
struct SobolOfOutput {
  std::string output;  ///< "final"
  bio::SobolFinding found;
  int basePoints;
};

/// Percentiles over time of the runs that reached the end, in shown units.
struct Band {
  std::vector<double> time, nominal, mean, p5, p50, p95;
};

/// The findings of `ensemble`. Rows are read one by one when they are needed.
struct EnsembleFindings {
  std::string modelFile, trialFile;
  std::string coordinate;
  const DrawTable& table;
  const std::vector<bio::DrawnParameter>& parameters;
  const bio::EnsembleRun& nominal;
  std::uint64_t count;                               ///< of rows
  std::function<DrawTable::Row(std::uint64_t)> row;  ///< by number, below `count`
  std::optional<bio::MeasuredChannel> measured;
  std::map<std::string, std::uint64_t> outcomes = {};  ///< number of simulations by outcome
  std::vector<std::vector<double>> outputs = {};       ///< by output, then by row; NaN: none
  Band band = {};
  std::optional<SobolOfOutput> sobol = {};
};

/// Fills outcomes, outputs and the band from the rows.
void collect(EnsembleFindings& findings);

/// draws.csv, band.csv and sobol.csv
void writeDraws(const EnsembleFindings& findings, std::ostream& out);
void writeBand(const EnsembleFindings& findings, std::ostream& out);
void writeSobol(const EnsembleFindings& findings, std::ostream& out);

void tellEnsemble(const EnsembleFindings& findings, Summary& summary);
Report ensembleReport(const EnsembleFindings& findings);

}  // namespace app
