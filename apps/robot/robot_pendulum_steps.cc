#include <fmt/format.h>

#include <cmath>

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "output/text.h"
#include "robot/robot_figures.h"
#include "robot/robot_optimise.h"
#include "robots/robot_designs.h"

namespace app {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

info::PlannedExperiment experimentOf(const TimedMotion& motion, std::size_t stepsPerSample) {
  std::vector<double> position;
  for (const VectorXd& u : motion.u) position.push_back(u[0]);
  return info::doublePendulumStepExperiment(position, motion.step, stepsPerSample);
}

// As many steps in continuous time, for comparison.
double continuousMsPerIteration(double step) {
  const info::FlowTask flow = info::doublePendulumFlowTask(step);
  const auto project = [&](const std::vector<Vector2d>&, const Inputs& from) {
    return std::make_unique<info::FlowProjection>(flow.system, flow.design, from);
  };
  return find({}, project, Vector2d(0.085, 0.5), flow.design, step, flow.design.desiredInput,
              {.maxIterations = 10, .largestMove = 2})
      .msPerIteration;
}

}  // namespace

ExitStatus optimisePendulumInSteps(const OptimiseRequest& request, const CommandContext& context,
                                   Summary& summary, Report& report, OutputFolder& folder) {
  const double step = 0.02;
  const auto every = static_cast<std::size_t>(request.stepsPerSample);
  info::StepTask task = info::doublePendulumStepTask(step, every);
  const Inputs start = prepare(request, context, task.design, step, 0.01);
  const auto project = [&](const std::vector<Vector2d>& theta, const Inputs& from) {
    return std::make_unique<info::StepProjection>(
        systemAt<info::ExtendedStepMap>(
            theta, [&](const Vector2d& at) { return info::doublePendulumSteps(step, 1e-2, at); }),
        task.design, from);
  };
  const Found found = find(request, project, Vector2d(0.085, 0.05), task.design, step, start,
                           {.slopeTolerance = 0.01});
  const info::SearchResult& s = found.search;
  const VectorXd before = eigenvaluesOf(s.informationStart), after = eigenvaluesOf(s.information);
  const MatrixXd boundBefore = s.informationStart.inverse(), boundAfter = s.information.inverse();
  const info::PlannedExperiment slowPlan = experimentOf(found.before, every),
                                fastPlan = experimentOf(found.after, every);
  const auto slow = simulateTrials(context, slowPlan, request.trials, "trials, start"),
             fast = simulateTrials(context, fastPlan, request.trials, "trials, optimised");
  summary.set("bound_initial", rowsOf(boundBefore));
  summary.set("bound_optimised", rowsOf(boundAfter));
  summary.set("monte_carlo_initial", rowsOf(slow.covariance));
  summary.set("monte_carlo_optimised", rowsOf(fast.covariance));
  summary.set("trials", request.trials);
  summary.set("trials_converged", {{"initial", slow.converged}, {"optimised", fast.converged}});
  summary.set("information_initial", rowsOf(s.informationStart));
  summary.set("information_optimised", rowsOf(s.information));
  summary.set("unit_c", "10e-3 kg m²/s");
  summary.set("samples_per_s", 1 / (step * static_cast<double>(every)));
  summary.set("lambda_min_factor", after[0] / before[0]);
  const double continuous = continuousMsPerIteration(step);
  summary.set("ms_per_iteration_continuous", continuous);

  report.mainFigure = stateFigure("Motion", "Angle [rad]", found, {{"link 1", 0}, {"link 2", 1}});
  report.details.emplace_back(Table{
      .title = fmt::format(
          "Exact information of 250 steps of 0.02 s, {} samples per second, c in 10e-3 kg m²/s",
          numberText(1 / (step * static_cast<double>(every)))),
      .columns = {"", "here", "Wilson's thesis, 50 samples per second"},
      .rows = {{"λ_min, start", numberText(before[0]), "543"},
               {"λ_max, start", numberText(before[1]), "5950"},
               {"λ_min, optimised", numberText(after[0]), "7.34e4"},
               {"λ_max, optimised", numberText(after[1]), "6.91e6"},
               {"factor of λ_min", numberText(after[0] / before[0]), "135"},
               {"iterations", std::to_string(s.iterations), "2"},
               {"ms per iteration, in steps", numberText(found.msPerIteration, 3), "39900"},
               {"ms per iteration, continuous", numberText(continuous, 3), "762500"}}});
  Table trials{.title = fmt::format("{} simulated experiments and the bound", request.trials),
               .columns = {"", "m1 m1 [kg²]", "m1 c [kg·10e-3 kg m²/s]", "c c [(10e-3 kg m²/s)²]"},
               .rows = {}};
  const auto row = [&](const char* what, const MatrixXd& of) {
    trials.rows.push_back({what, numberText(of(0, 0)), numberText(of(0, 1)), numberText(of(1, 1))});
  };
  row("Cramér–Rao bound, start", boundBefore);
  row("Monte Carlo, start", slow.covariance);
  row("Cramér–Rao bound, optimised", boundAfter);
  row("Monte Carlo, optimised", fast.covariance);
  report.details.emplace_back(trials);
  report.details.emplace_back(informationFigure(found));
  report.details.emplace_back(inputFigure("Cart position [m]", found));
  report.details.emplace_back(histogram("m1 [kg], start", slow, 0, slowPlan.truth[0]));
  report.details.emplace_back(histogram("m1 [kg], optimised", fast, 0, fastPlan.truth[0]));
  report.details.emplace_back(histogram("c [10e-3 kg m²/s], start", slow, 1, slowPlan.truth[1]));
  report.details.emplace_back(
      histogram("c [10e-3 kg m²/s], optimised", fast, 1, fastPlan.truth[1]));
  tellSearch(found, {"angle1_rad", "angle2_rad", "momentum1_kg_m2_per_s", "momentum2_kg_m2_per_s"},
             summary, report, folder);
  report.verdict = fmt::format(
      "The optimised motion gives {} times as much information about the least determined "
      "direction; it was found in {} iterations of {} ms (continuous time: {} ms).",
      numberText(after[0] / before[0]), s.iterations, numberText(found.msPerIteration, 3),
      numberText(continuous, 3));
  return statusOf(found, report);
}

}  // namespace app
