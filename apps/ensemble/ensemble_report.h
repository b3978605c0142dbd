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

/// Percentiles over time of the runs that reached the end, in shown units.
struct Band {
  std::vector<double> time, nominal, mean, p5, p50, p95;
};

/// The findings about a channel.
struct ChannelFindings {
  std::vector<bio::Spread> outputs = {};  ///< by output, in shown units
  std::vector<double> decomposed = {};    ///< for Sobol's indices, by row: that output; NaN: none
  std::uint64_t leftRange = 0;            ///< number of runs that leave the coordinate's range
  Band band = {};
  std::optional<bio::SobolFinding> sobol = {};
};

/// The findings of `ensemble`. Rows are read one by one when they are needed.
struct EnsembleFindings {
  std::string modelFile, trialFile;
  const bio::TrialEnsemble& ensemble;
  const DrawTable& table;
  std::function<DrawTable::Row(std::uint64_t)> row;    ///< by number, below `ensemble.count()`
  std::string output;                                  ///< that of Sobol's indices
  int basePoints;                                      ///< of Sobol's indices
  std::map<std::string, std::uint64_t> outcomes = {};  ///< number of simulations by outcome
  std::vector<ChannelFindings> channels = {};          ///< as the table has them
};

/// Fills outcomes and channels, without Sobol's indices, from the rows, in several passes that keep
/// no more of long columns than info::PassQuantiles does.
/// @param decomposed whether the values of the output for Sobol's indices are kept
void collect(EnsembleFindings& findings, bool decomposed);

/// draws.csv, band.csv and sobol.csv
void writeDraws(const EnsembleFindings& findings, std::ostream& out);
void writeBand(const EnsembleFindings& findings, std::ostream& out);
void writeSobol(const EnsembleFindings& findings, std::ostream& out);

void tellEnsemble(const EnsembleFindings& findings, Summary& summary);
Report ensembleReport(const EnsembleFindings& findings);

}  // namespace app
