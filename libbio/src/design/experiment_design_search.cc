#include <cmath>

#include "bio/design/experiment_design.h"
#include "info/design/design_search.h"

namespace bio {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Simulations of a search, from several threads.
class ExperimentDesign::Runs {
 public:
  Runs(const ExperimentDesign& design, const DesignSearchSettings& settings, DesignResult& result)
      : design_(design),
        search_(design.inputs_, settings,
                result.costBefore = phi(design.scaledInformation(result.before.gamma)),
                settings.iterations * (static_cast<double>(design.inputs_.profiles().size()) + 2),
                result) {}

  info::DesignOutcome run(const VectorXd& x) {
    info::DesignOutcome outcome;
    if (search_.isStopped()) return outcome;
    double value = InputSearch::worthless;
    bool keeps = false;
    try {
      const SensitivityTrajectory s = design_.simulateTrial(design_.inputs_.at(x));
      outcome.possible = s.motion.outcome == Outcome::completed;
      if (outcome.possible) {
        constexpr double price = 1;
        outcome.information = design_.scaledInformation(design_.observed_.linearised(s).gamma);
        outcome.penalty = design_.penalty(s, price);
        value = phi(outcome.information);
        keeps =
            design_.inputs_.profiles().excess(x) < 1e-9 && design_.keepsRanges(design_.rangesOf(s));
      }
    } catch (const NoStaticEquilibrium&) {
      // impossible
    }
    search_.note(x, outcome.possible, keeps ? value : InputSearch::worthless);
    return outcome;
  }

  double costOf(const VectorXd& x) {
    const info::DesignOutcome outcome = run(x);
    return outcome.possible ? phi(outcome.information) + outcome.penalty : InputSearch::worthless;
  }

  const InputSearch& search() const { return search_; }

 private:
  double phi(const MatrixXd& information) const {
    try {
      const double value = design_.cost(information, 1e-9).value;
      return std::isfinite(value) ? value : InputSearch::worthless;
    } catch (const std::domain_error&) {
      return InputSearch::worthless;
    }
  }

  const ExperimentDesign& design_;
  InputSearch search_;
};

DesignResult ExperimentDesign::search(const DesignSearchSettings& settings) const {
  DesignResult result;
  result.before = before();
  result.after = result.before;
  Runs runs(*this, settings, result);
  const auto costOf = [&](const VectorXd& inputs) { return runs.costOf(inputs); };
  const auto project = [&](const VectorXd& inputs) { return inputs_.profiles().project(inputs); };
  const VectorXd x = runs.search().evolve(costOf);
  if (settings.iterations > 0 && !runs.search().isStopped() && std::isfinite(costOf(x))) {
    const auto isStopped = [&] { return runs.search().isStopped(); };
    info::DesignSearch fine(
        {[&](const VectorXd& inputs) { return runs.run(inputs); }, project,
         [&](const MatrixXd& I, double tolerance) { return cost(I, tolerance); }},
        x, {1e-3, settings.threads, isStopped});
    info::SearchOptions options;
    options.maxIterations = settings.iterations;
    options.slopeTolerance = 1e-4;
    options.armijoSlope = 1e-3;
    options.maxShrinks = 10;
    if (question_.parameters.size() == 1) options.stuckTolerance = options.repeatedTolerance;
    options.progress = [&](const info::SearchProgress&) { return !isStopped(); };
    info::search(fine, options);
  }
  if (runs.search().bestInputs().size() > 0) {
    DesignedExperiment e = at(runs.search().bestInputs());
    if (keepsLimits(e)) {
      result.after = std::move(e);
      result.improved = true;
    }
  }
  return result;
}

}  // namespace bio
