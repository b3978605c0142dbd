#include <fmt/format.h>

#include "info/design/projection.h"
#include "info/estimation/estimate.h"
#include "output/text.h"
#include "robot/robot_laboratory.h"
#include "robot/robot_optimise.h"
#include "robots/robot_designs.h"

namespace app {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;
using info::Method;

LaboratoryRobot massInLaboratory(const info::LaboratoryEffects& effects) {
  LaboratoryRobot robot;
  robot.truth = Vector2d(0.124, 0.50);
  robot.experiment = [](const info::CartMotion& motion) {
    return info::suspendedMassExperiment(motion);
  };
  robot.measure = [=, truth = robot.truth](const info::CartMotion& motion, std::uint64_t seed) {
    return info::measureSuspendedMass(motion, truth, effects, seed);
  };
  robot.thesis = {{{"0.100", "0.60"},
                   {"0.124", "0.50"},
                   {"0.121", "1.11"},
                   {"2.4 %", "122 %"},
                   {"0.121", "0.51"},
                   {"2.4 %", "2.0 %"}}};
  robot.thesisTable = "4.7";
  robot.range = {{0.08, 0.16}, {0.3, 1.2}};
  return robot;
}

// On exact data, from (0.10 kg, 0.60 m) to (0.12 kg, 0.50 m).
info::LeastSquares exactProblem(const TimedMotion& motion) {
  const auto plan = info::suspendedMassExperiment(cartMotion(motion, 1));
  return {plan.predictor, {plan.predictor.outputs(plan.truth), plan.covariance}, plan.parameters};
}

info::Estimate approach(const info::LeastSquares& problem, Method method) {
  return info::estimate(problem, {.method = method, .maxIterations = 1001, .costTolerance = 1e-6});
}

}  // namespace

ExitStatus optimiseSuspendedMass(const OptimiseRequest& request, const CommandContext& context,
                                 Summary& summary, Report& report, OutputFolder& folder) {
  const double step = 0.01;
  info::FlowTask task = info::suspendedMassFlowTask(step);
  const Inputs start = prepare(request, context, task.design, step, 0.0476);
  const auto project = [&](const std::vector<Vector2d>& theta, const Inputs& from) {
    return std::make_unique<info::FlowProjection>(
        systemAt<info::ExtendedFlow>(theta, info::suspendedMassFlow), task.design, from);
  };
  const Found found =
      find(request, project, Vector2d(0.10, 0.60), task.design, step, start, {.largestMove = 2});
  const VectorXd before = eigenvaluesOf(found.search.informationStart),
                 after = eigenvaluesOf(found.search.information);
  summary.set("condition_initial", before[1] / before[0]);
  summary.set("condition_optimised", after[1] / after[0]);
  summary.set("lambda_max_initial", before[1]);
  summary.set("lambda_max_optimised", after[1]);

  const info::LeastSquares slowProblem = exactProblem(found.before),
                           fastProblem = exactProblem(found.after);
  const int slow = approach(slowProblem, Method::gradientDescent).iterations,
            fast = approach(fastProblem, Method::gradientDescent).iterations;
  const info::Estimate squaresSlow = approach(slowProblem, Method::iteratedLeastSquares),
                       squaresFast = approach(fastProblem, Method::iteratedLeastSquares);
  summary.set("gradient_descent_iterations", {{"initial", slow}, {"optimised", fast}});
  summary.set("iterated_least_squares_iterations",
              {{"initial", squaresSlow.iterations}, {"optimised", squaresFast.iterations}});
  const auto count = [](int n) { return n > 1000 ? std::string("> 1000") : std::to_string(n); };

  report.mainFigure = stateFigure("Motion", "Angle [rad]", found, {{"string", 1}});
  report.details.emplace_back(
      Table{.title = "Initial and optimised motion",
            .columns = {"", "start", "optimised", "thesis"},
            .rows = {{"κ", numberText(before[1] / before[0]), numberText(after[1] / after[0]),
                      "1.73e8 to 19.3"},
                     {"λ1", numberText(before[1]), numberText(after[1]), "3.18e6 to 3.63e6"},
                     {"λ2", numberText(before[0]), numberText(after[0]), "0.0184 to 1.88e5"},
                     {"iterations of gradient descent", count(slow), count(fast), "> 1000 to 27"},
                     {"iterations of iterated least squares", count(squaresSlow.iterations),
                      count(squaresFast.iterations), "5 to 3"}}});
  report.details.emplace_back(stateFigure("Cart", "Position [m]", found, {{"cart", 0}}));
  report.details.emplace_back(inputFigure("Cart acceleration [m/s²]", found));
  report.details.emplace_back(informationFigure(found));
  const auto map = [&](const char* title, const info::LeastSquares& problem,
                       const info::Estimate& way) {
    report.details.emplace_back(
        basinFigure({title, {{0.06, 0.18}, {0.3, 1.0}}, Vector2d(0.12, 0.50)}, problem,
                    way.parameterHistory, context.threads));
  };
  map("Cost of the estimator on exact data, initial motion", slowProblem, squaresSlow);
  map("Cost of the estimator on exact data, optimised motion", fastProblem, squaresFast);
  if (request.lab)
    tellLaboratory(massInLaboratory(*request.lab), *request.lab, cartMotion(found.before, 1),
                   cartMotion(found.after, 1), context, summary, report);
  tellSearch(found, {"cart_m", "angle_rad", "cart_m_per_s", "rate_rad_per_s"}, summary, report,
             folder);
  report.verdict = fmt::format(
      "The condition number of the information falls from {} to {}; gradient descent needs {} "
      "iterations instead of {}.",
      numberText(before[1] / before[0], 3), numberText(after[1] / after[0], 3), count(fast),
      count(slow));
  return statusOf(found, report);
}

}  // namespace app
