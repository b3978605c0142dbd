#include "bio/analysis/ensemble_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/model/units.h"
#include "info/probability/quantile.h"

namespace bio {

const std::vector<EnsembleOutput>& ensembleOutputs() {
  static const std::vector<EnsembleOutput> list = {
      {"rms_error", "RMS error", [](const ChannelRun& r) { return r.rmsError; }},
      {"rms_from_nominal", "RMS difference from nominal",
       [](const ChannelRun& r) { return r.rmsFromNominal; }},
      {"final", "final value", [](const ChannelRun& r) { return r.last; }},
      {"min", "smallest value", [](const ChannelRun& r) { return r.lowest; }},
      {"max", "largest value", [](const ChannelRun& r) { return r.highest; }}};
  return list;
}

std::size_t ensembleOutputNamed(const std::string& name) {
  const auto& all = ensembleOutputs();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
  }
  throw std::invalid_argument(
      fmt::format("output '{}', must be rms_error, rms_from_nominal, final, min or max", name));
}

Spread spreadOf(const std::vector<double>& values) {
  std::vector<double> finite;
  for (const double x : values) {
    if (std::isfinite(x)) finite.push_back(x);
  }
  const auto n = static_cast<double>(finite.size());
  double mean = 0, squares = 0;
  for (const double x : finite) mean += x / n;
  for (const double x : finite) squares += (x - mean) * (x - mean);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (finite.empty()) mean = none;
  return {mean, finite.size() > 1 ? std::sqrt(squares / (n - 1)) : none,
          info::quantileOf(finite, 0.05), info::quantileOf(finite, 0.5),
          info::quantileOf(finite, 0.95)};
}

info::PassQuantiles spreadColumns(std::size_t columns) {
  return {columns, {0.05, 0.5, 0.95}};
}

Spread spreadOf(const info::PassQuantiles& columns, std::size_t column) {
  return {columns.mean(column), columns.sd(column), columns.quantile(column, 0),
          columns.quantile(column, 1), columns.quantile(column, 2)};
}

std::vector<double> bandTimes(double startTime, double duration, int points) {
  std::vector<double> times;
  for (int i = 0; i < points; ++i) times.push_back(startTime + duration * i / (points - 1));
  return times;
}

SobolFinding sobolOf(const std::vector<double>& values, int parameters, std::uint64_t seed) {
  std::vector<Eigen::VectorXd> outputs;
  for (const double y : values) {
    outputs.push_back(std::isfinite(y) ? Eigen::VectorXd::Constant(1, y) : Eigen::VectorXd());
  }
  constexpr int replicates = 500;
  return {info::sobolIndices(outputs, parameters),
          info::bootstrapSobol(outputs, parameters, replicates, seed)};
}

bool leavesRange(const Coordinate& coordinate, double lowest, double highest) {
  const double least = coordinate.isRotation ? radiansPerDegree : 1e-3;
  const double margin = std::max(0.1 * (coordinate.rangeMax - coordinate.rangeMin), least);
  return lowest < coordinate.rangeMin - margin || highest > coordinate.rangeMax + margin;
}

}  // namespace bio
