#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bio/analysis/ensemble.h"
#include "info/probability/global_sensitivity.h"
#include "info/probability/pass_quantiles.h"

/// Statistics of the runs of an ensemble.
namespace bio {

/// A scalar output of every channel of every run.
struct EnsembleOutput {
  std::string name;                 ///< "rms_error"
  std::string words;                ///< "RMS error"
  double (*of)(const ChannelRun&);  ///< in the channel's unit; NaN unless the run reached the end
};
/// rms_error, rms_from_nominal, final, min, max.
const std::vector<EnsembleOutput>& ensembleOutputs();
/// Place among ensembleOutputs().
/// @throws std::invalid_argument for another name
std::size_t ensembleOutputNamed(const std::string& name);

/// Mean, sample standard deviation and percentiles of the finite values.
struct Spread {
  double mean;          ///< NaN without a finite value
  double sd;            ///< NaN with fewer than two
  double p5, p50, p95;  ///< as quantileOf (quantile.h) has them; NaN without a finite value
};
Spread spreadOf(const std::vector<double>& values);

/// Percentiles of columns of any length, for spreadOf(columns, column).
info::PassQuantiles spreadColumns(std::size_t columns);
/// @param columns  of spreadColumns(), after the last pass
Spread spreadOf(const info::PassQuantiles& columns, std::size_t column);

/// Times of a percentile band: first and last of the trial, and between them equal distances [s].
/// @param points ≥ 2
std::vector<double> bandTimes(double startTime, double duration, int points);

/// Sobol's indices of one output, with 95 % intervals by resampling the base points.
struct SobolFinding {
  info::SobolResult indices;
  info::SobolIntervals intervals;
};
/// @param values  of the runs 0 … n·(p + 2) − 1 of Saltelli's scheme (sobolPoint); NaN: the run did
///   not reach the end, its point is left out
SobolFinding sobolOf(const std::vector<double>& values, int parameters, std::uint64_t seed);

/// Whether a run leaves the coordinate's range by more than a tenth of it, and by 1° or 1 mm.
/// @param lowest, highest  of the run [rad] or [m]; NaN: it did not reach the end, false
bool leavesRange(const Coordinate& coordinate, double lowest, double highest);

}  // namespace bio
