#include "info/estimation/monte_carlo.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "info/information/fisher.h"
#include "info/parallel_for.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd drawNoise(const OutputCovariance& covariance, Index n, RandomStream& random) {
  MatrixXd noise(covariance.outputs(), n);
  const MatrixXd root = covariance.sigma().llt().matrixL();
  for (Index k = 0; k < n; ++k) {
    for (double& entry : noise.col(k)) entry = random.normal();
    noise.col(k) = (root * noise.col(k)).eval();
  }
  return noise;
}

MonteCarloResult monteCarlo(const Predictor& predictor, const VectorXd& truth,
                            const OutputCovariance& covariance,
                            const std::vector<Parameter>& parameters,
                            const MonteCarloOptions& options, const ObservationMask& observed) {
  if (options.trials < 1)
    throw std::invalid_argument(
        fmt::format("Monte Carlo: trials = {} must be ≥ 1", options.trials));
  if (options.threads < 0)
    throw std::invalid_argument(
        fmt::format("Monte Carlo: threads = {} must be ≥ 0", options.threads));
  if (!(options.startSpread >= 0 && std::isfinite(options.startSpread)))
    throw std::invalid_argument(
        fmt::format("Monte Carlo: startSpread = {} must be ≥ 0", options.startSpread));
  if (truth.size() != static_cast<Index>(parameters.size()))
    throw std::invalid_argument(
        fmt::format("Monte Carlo: {} true values for {} parameters, must be as many", truth.size(),
                    parameters.size()));
  std::vector<Parameter> atTruth = parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    atTruth[i].start = truth[static_cast<Index>(i)];
  const Prediction exact = predictor.withSensitivities(truth);
  // checks truth, bounds and shapes once, before any thread starts
  const LeastSquares reference(predictor, {exact.outputs, covariance, observed}, atTruth);

  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(label(parameter));

  MonteCarloResult result;
  result.bound = cramerRaoBound(fisherInformation(exact.gamma, covariance, observed), names);
  result.trials.resize(static_cast<std::size_t>(options.trials));
  std::vector<char> ran(result.trials.size(), false);
  std::mutex reporting;
  int done = 0;
  std::atomic<bool> stop = false;
  parallelFor(options.trials, options.threads, [&](int i) {
    if (stop) return;
    RandomStream random(options.seed, static_cast<std::uint64_t>(i));
    // the start first, so that it does not depend on the number of samples
    MonteCarloTrial trial;
    trial.start = truth;
    for (Index j = 0; j < truth.size(); ++j) {
      const Parameter& parameter = parameters[static_cast<std::size_t>(j)];
      const double drawn = truth[j] * (1 + options.startSpread * (2 * random.uniform() - 1));
      trial.start[j] = std::clamp(drawn, parameter.lower, parameter.upper);
    }
    const MatrixXd data = exact.outputs + drawNoise(covariance, exact.outputs.cols(), random);
    const LeastSquares problem(predictor, {data, covariance, observed}, atTruth);
    const Estimate estimated = info::estimate(problem, trial.start, options.estimate);
    trial.parameters = estimated.parameters;
    trial.cost = estimated.cost;
    trial.why = estimated.why;
    trial.converged = estimated.converged;
    trial.iterations = estimated.iterations;
    result.trials[static_cast<std::size_t>(i)] = std::move(trial);
    ran[static_cast<std::size_t>(i)] = true;
    const std::lock_guard lock(reporting);
    ++done;
    if (options.progress && !stop && !options.progress(done, options.trials)) stop = true;
  });

  // sums in the order of the trials: the same bits for any number of threads
  if (stop) {
    result.complete = done == options.trials;
    std::vector<MonteCarloTrial> kept;
    for (std::size_t i = 0; i < ran.size(); ++i)
      if (ran[i]) kept.push_back(std::move(result.trials[i]));
    result.trials = std::move(kept);
  }
  result.mean = VectorXd::Zero(truth.size());
  for (const MonteCarloTrial& trial : result.trials)
    if (trial.converged) {
      ++result.converged;
      result.mean += trial.parameters;
    }
  result.mean /= result.converged;
  result.covariance = MatrixXd::Zero(truth.size(), truth.size());
  for (const MonteCarloTrial& trial : result.trials)
    if (trial.converged)
      result.covariance +=
          (trial.parameters - result.mean) * (trial.parameters - result.mean).transpose();
  result.covariance /=
      result.converged > 1 ? result.converged - 1 : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace info
