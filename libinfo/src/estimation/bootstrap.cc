#include "info/estimation/bootstrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "info/parallel_for.h"
#include "info/probability/quantile.h"
#include "info/probability/random_stream.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Noise like the residuals, series by series in blocks.
MatrixXd drawBlocks(const MatrixXd& residuals, const std::vector<Index>& series, Index blockLength,
                    RandomStream& random) {
  MatrixXd drawn(residuals.rows(), residuals.cols());
  Index first = 0;
  for (const Index length : series) {
    for (Index k = 0; k < length; k += blockLength) {
      const auto from = static_cast<Index>(random.uniform() * static_cast<double>(length));
      for (Index j = 0; j < std::min(blockLength, length - k); ++j) {
        drawn.col(first + k + j) = residuals.col(first + (from + j) % length);
      }
    }
    first += length;
  }
  return drawn;
}

void check(const LeastSquares& problem, const std::vector<Index>& series,
           const BootstrapOptions& options) {
  if (options.replicates < 2) {
    throw std::invalid_argument(
        fmt::format("bootstrap: replicates = {} must be ≥ 2", options.replicates));
  }
  if (options.blockLength < 1) {
    throw std::invalid_argument(
        fmt::format("bootstrap: blockLength = {} must be ≥ 1", options.blockLength));
  }
  const Index samples = problem.measurements().outputs.cols();
  if (std::accumulate(series.begin(), series.end(), Index{0}) != samples ||
      std::any_of(series.begin(), series.end(), [](Index n) { return n < 1; })) {
    throw std::invalid_argument(
        fmt::format("bootstrap: lengths of the series must add up to {} samples", samples));
  }
  if (problem.observations() != problem.measurements().outputs.size()) {
    throw std::invalid_argument("bootstrap: every sample must have been observed");
  }
}

}  // namespace

BootstrapResult bootstrap(const LeastSquares& problem, const Estimate& estimated,
                          std::vector<Index> series, const BootstrapOptions& options) {
  const Measurements& measured = problem.measurements();
  if (series.empty()) series = {measured.outputs.cols()};
  check(problem, series, options);
  const MatrixXd predicted = problem.predictor().outputs(estimated.parameters);
  MatrixXd residuals = measured.outputs - predicted;
  residuals.colwise() -= residuals.rowwise().mean().eval();
  const auto n = static_cast<double>(measured.outputs.size());
  const auto p = static_cast<double>(estimated.parameters.size());
  residuals *= std::sqrt(n / std::max(1.0, n - p));

  std::vector<std::optional<VectorXd>> found(static_cast<std::size_t>(options.replicates));
  std::mutex reporting;
  std::atomic<bool> stop = false;
  int done = 0;
  parallelFor(options.replicates, options.threads, [&](int i) {
    if (stop) return;
    RandomStream random(options.seed, static_cast<std::uint64_t>(i));
    std::vector<Parameter> parameters = problem.parameters();
    for (Parameter& parameter : parameters) {
      if (parameter.prior) parameter.prior->mean += parameter.prior->sd * random.normal();
    }
    Measurements anew = measured;
    anew.outputs = predicted + drawBlocks(residuals, series, options.blockLength, random);
    const LeastSquares again(problem.predictor(), anew, parameters);
    const Estimate one = estimate(again, estimated.parameters, options.estimate);
    if (one.converged) found[static_cast<std::size_t>(i)] = one.parameters;
    const std::lock_guard lock(reporting);
    ++done;
    if (options.progress && !stop && !options.progress(done, options.replicates)) stop = true;
  });

  BootstrapResult result;
  result.complete = done == options.replicates;
  for (const auto& one : found) result.converged += one.has_value();
  result.parameters.resize(estimated.parameters.size(), result.converged);
  Index column = 0;
  for (const auto& one : found) {
    if (one) result.parameters.col(column++) = *one;
  }
  result.sd = VectorXd::Constant(estimated.parameters.size(), std::nan(""));
  result.intervals = Eigen::MatrixX2d::Constant(estimated.parameters.size(), 2, std::nan(""));
  if (result.converged < 2) return result;
  const double tail = 0.5 * (1 - options.estimate.confidence);
  for (Index j = 0; j < result.parameters.rows(); ++j) {
    const VectorXd row = result.parameters.row(j);
    result.sd[j] = std::sqrt((row.array() - row.mean()).square().sum() /
                             static_cast<double>(result.converged - 1));
    const std::vector<double> values(row.begin(), row.end());
    result.intervals(j, 0) = quantileOf(values, tail);
    result.intervals(j, 1) = quantileOf(values, 1 - tail);
  }
  return result;
}

}  // namespace info
