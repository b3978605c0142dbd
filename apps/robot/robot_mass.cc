#include <fmt/format.h>

#include "info/information/symmetric_eigen.h"
#include "output/text.h"
#include "robot/robot_laboratory.h"
#include "robot/robot_optimise.h"

namespace app {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

ThesisLaboratory massLaboratoryOfThesis() {
  return {"4.7",
          {{{"0.100", "0.60"},
            {"0.124", "0.50"},
            {"0.121", "1.11"},
            {"2.4 %", "122 %"},
            {"0.121", "0.51"},
            {"2.4 %", "2.0 %"}}},
          {{0.08, 0.16}, {0.3, 1.2}}};
}

}  // namespace

void tellSuspendedMass(const MotionResult& found, const CommandContext& context, Summary& summary,
                       Report& report) {
  const VectorXd before = info::symmetricEigenvalues(found.search.informationStart),
                 after = info::symmetricEigenvalues(found.search.information);
  summary.set("condition_initial", before[1] / before[0]);
  summary.set("condition_optimised", after[1] / after[0]);
  summary.set("lambda_max_initial", before[1]);
  summary.set("lambda_max_optimised", after[1]);

  const int slow = found.exactBefore->gradientDescent.iterations,
            fast = found.exactAfter->gradientDescent.iterations;
  const info::Estimate &squaresSlow = found.exactBefore->iteratedLeastSquares,
                       &squaresFast = found.exactAfter->iteratedLeastSquares;
  summary.set("gradient_descent_iterations", {{"initial", slow}, {"optimised", fast}});
  summary.set("iterated_least_squares_iterations",
              {{"initial", squaresSlow.iterations}, {"optimised", squaresFast.iterations}});
  const auto count = [](int n) { return n > 1000 ? std::string("> 1000") : std::to_string(n); };

  report.mainFigure = stateFigure("Motion", "Angle [rad]", found, {{"string", 1}});
  report.details.emplace_back(
      Section{"Information",
              "How well the two parameters can be told apart: κ is the condition number of the "
              "information, λ1 and λ2 are its eigenvalues, beside the numbers of Wilson's "
              "thesis."});
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
  report.details.emplace_back(informationFigure(found));
  report.details.emplace_back(
      Section{"Motion of the cart", "What the search changed; dashed lines are before it."});
  report.details.emplace_back(stateFigure("Cart", "Position [m]", found, {{"cart", 0}}));
  report.details.emplace_back(inputFigure("Cart acceleration [m/s²]", found));
  report.details.emplace_back(
      Section{"Estimation",
              "The cost of the estimator over both parameters, and its way to the minimum: a long "
              "valley means that a combination of them is hardly determined."});
  const auto map = [&](const char* title, const info::robot::ExactEstimates& exact) {
    report.details.emplace_back(
        basinFigure({title, {{0.06, 0.18}, {0.3, 1.0}}, Vector2d(0.12, 0.50)}, exact.problem,
                    exact.iteratedLeastSquares.parameterHistory, context.threads));
  };
  map("Cost of the estimator on exact data, initial motion", *found.exactBefore);
  map("Cost of the estimator on exact data, optimised motion", *found.exactAfter);
  if (found.laboratory)
    tellLaboratory(*found.laboratory, massLaboratoryOfThesis(), context, summary, report);
  report.verdict = fmt::format(
      "The condition number of the information falls from {} to {}; gradient descent needs {} "
      "iterations instead of {}.",
      numberText(before[1] / before[0], 3), numberText(after[1] / after[0], 3), count(fast),
      count(slow));
}

}  // namespace app
