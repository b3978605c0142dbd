#pragma once

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "ensemble_draws.h"
#include "info/global_sensitivity.h"
#include "report.h"

namespace app {

/// Sobol's indices of one output.
struct SobolFinding {
  std::string output;  ///< "final"
  info::SobolResult indices;
  info::SobolIntervals intervals;
  int basePoints;
};

/// The course over time of the runs that came to their end; people's units.
struct Band {
  std::vector<double> time, nominal, mean, p5, p50, p95;
};

/// All that `ensemble` found, from rows in the order of their numbers.
struct EnsembleFindings {
  std::string modelFile, trialFile;
  std::string coordinate;
  const DrawTable& table;
  const std::vector<DrawnParameter>& parameters;
  const bio::EnsembleRun& nominal;
  std::vector<DrawTable::Row> rows;
  std::optional<bio::MeasuredMotion> measured;
  std::optional<SobolFinding> sobol = {};
};

/// What is known of one output over the runs that came to their end.
struct Spread {
  double mean, deviation, p5, p50, p95;
};
Spread spreadOf(const std::vector<double>& values);

Band bandOf(const EnsembleFindings& findings);

/// draws.csv, band.csv and sobol.csv
void writeDraws(const EnsembleFindings& findings, std::ostream& out);
void writeBand(const EnsembleFindings& findings, std::ostream& out);
void writeSobol(const EnsembleFindings& findings, std::ostream& out);

void tellEnsemble(const EnsembleFindings& findings, Summary& summary);
Report ensembleReport(const EnsembleFindings& findings);

}  // namespace app
