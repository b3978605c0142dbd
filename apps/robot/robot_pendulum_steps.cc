#include <fmt/format.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"
#include "output/text.h"
#include "robot/robot_figures.h"
#include "robot/robot_optimise.h"
#include "robot/robot_trials.h"

namespace app {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void tellPendulumInSteps(const MotionResult& found, int stepsPerSample, Summary& summary,
                         Report& report) {
  const info::SearchResult& s = found.search;
  const VectorXd before = info::symmetricEigenvalues(s.informationStart),
                 after = info::symmetricEigenvalues(s.information);
  const MatrixXd &boundBefore = found.boundBefore, &boundAfter = found.boundAfter;
  const info::PlannedExperiment &slowPlan = found.trialsBefore->plan,
                                &fastPlan = found.trialsAfter->plan;
  const info::MonteCarloResult &slow = found.trialsBefore->result,
                               &fast = found.trialsAfter->result;
  const double step = found.before.step, ms = 1e3 * found.secondsPerIteration;
  summary.set("bound_initial", rowsOf(boundBefore));
  summary.set("bound_optimised", rowsOf(boundAfter));
  summary.set("monte_carlo_initial", rowsOf(slow.covariance));
  summary.set("monte_carlo_optimised", rowsOf(fast.covariance));
  summary.set("trials", slow.trials.size());
  summary.set("trials_converged", {{"initial", slow.converged}, {"optimised", fast.converged}});
  summary.set("information_initial", rowsOf(s.informationStart));
  summary.set("information_optimised", rowsOf(s.information));
  summary.set("unit_c", "10e-3 kg m²/s");
  summary.set("samples_per_s", 1 / (step * stepsPerSample));
  summary.set("lambda_min_factor", after[0] / before[0]);
  const double continuous = 1e3 * info::robot::secondsPerContinuousIteration(step);
  summary.set("ms_per_iteration_continuous", continuous);

  report.mainFigure = stateFigure("Motion", "Angle [rad]", found, {{"link 1", 0}, {"link 2", 1}});
  report.details.emplace_back(
      Section{"Information",
              "What one experiment tells of the parameters: the information and its bounds, and "
              "estimates from simulated experiments, beside the numbers of Wilson's thesis."});
  report.details.emplace_back(Table{
      .title = fmt::format(
          "Exact information of 250 steps of 0.02 s, {} samples per second, c in 10e-3 kg m²/s",
          numberText(1 / (step * stepsPerSample))),
      .columns = {"", "here", "Wilson's thesis, 50 samples per second"},
      .rows = {{"λ_min, start", numberText(before[0]), "543"},
               {"λ_max, start", numberText(before[1]), "5950"},
               {"λ_min, optimised", numberText(after[0]), "7.34e4"},
               {"λ_max, optimised", numberText(after[1]), "6.91e6"},
               {"factor of λ_min", numberText(after[0] / before[0]), "135"},
               {"iterations", std::to_string(s.iterations), "2"},
               {"ms per iteration, in steps", numberText(ms, 3), "39900"},
               {"ms per iteration, continuous", numberText(continuous, 3), "762500"}}});
  Table trials{.title = fmt::format("{} simulated experiments and the bound", slow.trials.size()),
               .columns = {"", "m1 m1 [kg²]", "m1 c [kg·10e-3 kg m²/s]", "c c [(10e-3 kg m²/s)²]"},
               .rows = {}};
  const auto row = [&](const char* what, const MatrixXd& matrix) {
    trials.rows.push_back(
        {what, numberText(matrix(0, 0)), numberText(matrix(0, 1)), numberText(matrix(1, 1))});
  };
  row("Cramér–Rao bound, start", boundBefore);
  row("Monte Carlo, start", slow.covariance);
  row("Cramér–Rao bound, optimised", boundAfter);
  row("Monte Carlo, optimised", fast.covariance);
  report.details.emplace_back(trials);
  report.details.emplace_back(informationFigure(found));
  report.details.emplace_back(
      Section{"Motion of the cart", "What the search changed; dashed lines are before it."});
  report.details.emplace_back(inputFigure("Cart position [m]", found));
  sayHistograms(report);
  report.details.emplace_back(histogram("m1 [kg], start", slow, 0, slowPlan.truth[0]));
  report.details.emplace_back(histogram("m1 [kg], optimised", fast, 0, fastPlan.truth[0]));
  report.details.emplace_back(histogram("c [10e-3 kg m²/s], start", slow, 1, slowPlan.truth[1]));
  report.details.emplace_back(
      histogram("c [10e-3 kg m²/s], optimised", fast, 1, fastPlan.truth[1]));
  report.verdict = fmt::format(
      "The optimised motion gives {} times as much information about the least determined "
      "direction; it was found in {} iterations of {} ms (continuous time: {} ms).",
      numberText(after[0] / before[0]), s.iterations, numberText(ms, 3), numberText(continuous, 3));
}

}  // namespace app
