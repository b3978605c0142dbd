#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "bio/design/experiment_design.h"
#include "info/design/cma_es.h"
#include "info/design/design_search.h"
#include "info/estimation/monte_carlo.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {
constexpr double worthless = std::numeric_limits<double>::infinity();
}

DesignResult ExperimentDesign::search(const DesignSearchSettings& settings) const {
  if (settings.candidates < 0 || settings.generations < 0 || settings.iterations < 0) {
    throw std::invalid_argument("candidates, generations and iterations must be ≥ 0");
  }
  DesignResult result;
  result.before = before();
  result.after = result.before;

  const auto phi = [&](const MatrixXd& information) {
    try {
      const double value = cost(information, 1e-9).value;
      return std::isfinite(value) ? value : worthless;
    } catch (const std::domain_error&) {
      return worthless;
    }
  };
  result.costBefore = phi(scaledInformation(result.before.gamma));

  // One run, and the memory of the best one that keeps all limits.
  constexpr int population = 16;
  const double planned = settings.candidates + 1 + population * settings.generations +
                         settings.iterations * (static_cast<double>(profiles().size()) + 2);
  std::mutex mutex;
  std::atomic<bool> stop{false};
  double best = result.costBefore;
  VectorXd bestInputs;
  const double price = 1;
  const auto run = [&](const VectorXd& x) {
    info::DesignOutcome outcome;
    if (stop) return outcome;
    double value = worthless;
    bool keeps = false;
    try {
      const SensitivityTrajectory s = simulateTrial(inputs_.at(x));
      outcome.possible = s.motion.outcome == Outcome::completed;
      if (outcome.possible) {
        outcome.information = scaledInformation(gammaOf(s));
        outcome.penalty = penalty(s, price);
        value = phi(outcome.information);
        const VectorXd q = s.motion.q.row(coordinate_).transpose();
        const VectorXd surprise = surpriseOf(s);
        keeps = profiles().excess(x) < 1e-9 &&
                keepsRange((q - surprise).minCoeff(), (q + surprise).maxCoeff(),
                           s.motion.qDot.row(coordinate_).cwiseAbs().maxCoeff());
      }
    } catch (const NoStaticEquilibrium&) {
      // impossible
    }
    const std::lock_guard lock(mutex);
    ++result.runs;
    if (!outcome.possible) ++result.impossible;
    if (keeps && value < best) {
      best = value;
      bestInputs = x;
      result.costs.push_back(value);
      result.foundAt.push_back(result.runs);
    }
    if (settings.progress && !settings.progress(std::min(1.0, result.runs / planned))) {
      stop = true;
    }
    return outcome;
  };
  const auto costOf = [&](const VectorXd& x) {
    const info::DesignOutcome outcome = run(x);
    return outcome.possible ? phi(outcome.information) + outcome.penalty : worthless;
  };
  const auto project = [&](const VectorXd& x) { return profiles().project(x); };

  // Candidates: the trial's own inputs, and random ones about them.
  std::vector<VectorXd> candidates(static_cast<std::size_t>(settings.candidates) + 1,
                                   inputs_.own());
  std::vector<double> costs(candidates.size());
  info::parallelFor(static_cast<int>(candidates.size()), settings.threads, [&](int i) {
    const auto si = static_cast<std::size_t>(i);
    if (i > 0) candidates[si] = inputs_.random(settings.seed, static_cast<std::uint64_t>(i));
    costs[si] = costOf(candidates[si]);
  });
  const auto first = std::min_element(costs.begin(), costs.end());
  VectorXd x = candidates[static_cast<std::size_t>(first - costs.begin())];

  if (settings.generations > 0 && !stop) {
    info::EvolutionOptions options;
    options.generations = settings.generations;
    options.population = population;
    options.spread = 0.2;
    options.seed = settings.seed;
    options.threads = settings.threads;
    options.progress = [&](int, double) { return !stop; };
    x = info::evolve(costOf, project, x, options).x;
  }
  if (settings.iterations > 0 && !stop && std::isfinite(costOf(x))) {
    info::DesignSearch fine(
        {run, project, [&](const MatrixXd& I, double tolerance) { return cost(I, tolerance); }}, x,
        {1e-3, settings.threads, [&] { return stop.load(); }});
    info::SearchOptions options;
    options.maxIterations = settings.iterations;
    options.slopeTolerance = 1e-4;
    options.armijoSlope = 1e-3;
    options.maxShrinks = 10;
    if (question_.parameters.size() == 1) options.stuckTolerance = options.repeatedTolerance;
    options.progress = [&](const info::SearchProgress&) { return !stop; };
    info::search(fine, options);
  }
  if (bestInputs.size() > 0) {
    DesignedExperiment e = at(bestInputs);
    if (keepsLimits(e)) {
      result.after = std::move(e);
      result.improved = true;
    }
  }
  result.stopped = stop;
  return result;
}

}  // namespace bio
