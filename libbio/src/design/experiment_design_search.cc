#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "bio/design/experiment_design.h"
#include "info/design/cma_es.h"
#include "info/design/design_search.h"
#include "info/parallel_for.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {
constexpr double worthless = std::numeric_limits<double>::infinity();
}

/// Simulations of a search, from several threads, and the memory of the best that keeps all limits.
class ExperimentDesign::Runs {
 public:
  Runs(const ExperimentDesign& design, const DesignSearchSettings& settings, double planned,
       DesignResult& result)
      : design_(design),
        settings_(settings),
        planned_(planned),
        result_(result),
        best_(phi(design.scaledInformation(result.before.gamma))) {
    result_.costBefore = best_;
  }

  double phi(const MatrixXd& information) const {
    try {
      const double value = design_.cost(information, 1e-9).value;
      return std::isfinite(value) ? value : worthless;
    } catch (const std::domain_error&) {
      return worthless;
    }
  }

  info::DesignOutcome run(const VectorXd& x) {
    info::DesignOutcome outcome;
    if (stop_) return outcome;
    double value = worthless;
    bool keeps = false;
    try {
      const SensitivityTrajectory s = design_.simulateTrial(design_.inputs_.at(x));
      outcome.possible = s.motion.outcome == Outcome::completed;
      if (outcome.possible) {
        constexpr double price = 1;
        outcome.information = design_.scaledInformation(design_.gammaOf(s));
        outcome.penalty = design_.penalty(s, price);
        value = phi(outcome.information);
        const VectorXd q = s.motion.q.row(design_.coordinate_).transpose();
        const VectorXd surprise = design_.surpriseOf(s);
        keeps = design_.profiles().excess(x) < 1e-9 &&
                design_.keepsRange((q - surprise).minCoeff(), (q + surprise).maxCoeff(),
                                   s.motion.qDot.row(design_.coordinate_).cwiseAbs().maxCoeff());
      }
    } catch (const NoStaticEquilibrium&) {
      // impossible
    }
    note(x, outcome.possible, keeps ? value : worthless);
    return outcome;
  }

  double costOf(const VectorXd& x) {
    const info::DesignOutcome outcome = run(x);
    return outcome.possible ? phi(outcome.information) + outcome.penalty : worthless;
  }

  bool isStopped() const { return stop_; }
  /// Inputs of the best run; empty if none is better than the trial itself.
  const VectorXd& bestInputs() const { return bestInputs_; }

 private:
  void note(const VectorXd& x, bool isPossible, double value) {
    const std::lock_guard lock(mutex_);
    ++result_.runs;
    if (!isPossible) ++result_.impossible;
    if (value < best_) {
      best_ = value;
      bestInputs_ = x;
      result_.costs.push_back(value);
      result_.foundAt.push_back(result_.runs);
    }
    if (settings_.progress && !settings_.progress(std::min(1.0, result_.runs / planned_))) {
      stop_ = true;
    }
  }

  const ExperimentDesign& design_;
  const DesignSearchSettings& settings_;
  double planned_;
  DesignResult& result_;
  double best_;
  VectorXd bestInputs_;
  std::mutex mutex_;
  std::atomic<bool> stop_{false};
};

VectorXd ExperimentDesign::bestCandidate(const DesignSearchSettings& settings, Runs& runs) const {
  std::vector<VectorXd> candidates(static_cast<std::size_t>(settings.candidates) + 1,
                                   inputs_.own());
  std::vector<double> costs(candidates.size());
  info::parallelFor(static_cast<int>(candidates.size()), settings.threads, [&](int i) {
    const auto si = static_cast<std::size_t>(i);
    if (i > 0) candidates[si] = inputs_.random(settings.seed, static_cast<std::uint64_t>(i));
    costs[si] = runs.costOf(candidates[si]);
  });
  const auto first = std::min_element(costs.begin(), costs.end());
  return candidates[static_cast<std::size_t>(first - costs.begin())];
}

DesignResult ExperimentDesign::search(const DesignSearchSettings& settings) const {
  if (settings.candidates < 0 || settings.generations < 0 || settings.iterations < 0) {
    throw std::invalid_argument("candidates, generations and iterations must be ≥ 0");
  }
  DesignResult result;
  result.before = before();
  result.after = result.before;
  constexpr int population = 16;
  const double planned = settings.candidates + 1 + population * settings.generations +
                         settings.iterations * (static_cast<double>(profiles().size()) + 2);
  Runs runs(*this, settings, planned, result);
  const auto costOf = [&](const VectorXd& inputs) { return runs.costOf(inputs); };
  const auto project = [&](const VectorXd& inputs) { return profiles().project(inputs); };

  VectorXd x = bestCandidate(settings, runs);
  if (settings.generations > 0 && !runs.isStopped()) {
    info::EvolutionOptions options;
    options.generations = settings.generations;
    options.population = population;
    options.spread = 0.2;
    options.seed = settings.seed;
    options.threads = settings.threads;
    options.progress = [&](int, double) { return !runs.isStopped(); };
    x = info::evolve(costOf, project, x, options).x;
  }
  if (settings.iterations > 0 && !runs.isStopped() && std::isfinite(costOf(x))) {
    info::DesignSearch fine(
        {[&](const VectorXd& inputs) { return runs.run(inputs); }, project,
         [&](const MatrixXd& I, double tolerance) { return cost(I, tolerance); }},
        x, {1e-3, settings.threads, [&] { return runs.isStopped(); }});
    info::SearchOptions options;
    options.maxIterations = settings.iterations;
    options.slopeTolerance = 1e-4;
    options.armijoSlope = 1e-3;
    options.maxShrinks = 10;
    if (question_.parameters.size() == 1) options.stuckTolerance = options.repeatedTolerance;
    options.progress = [&](const info::SearchProgress&) { return !runs.isStopped(); };
    info::search(fine, options);
  }
  if (runs.bestInputs().size() > 0) {
    DesignedExperiment e = at(runs.bestInputs());
    if (keepsLimits(e)) {
      result.after = std::move(e);
      result.improved = true;
    }
  }
  result.stopped = runs.isStopped();
  return result;
}

}  // namespace bio
