#include <fmt/format.h>

#include <cmath>

#include "info/information/symmetric_eigen.h"
#include "output/text.h"
#include "robot/robot_laboratory.h"
#include "robot/robot_optimise.h"

namespace app {
namespace {

using Eigen::MatrixXd;

void addRow(Table& table, const std::string& what, const MatrixXd& ours,
            const std::string& thesis) {
  table.rows.push_back(
      {what, numberText(ours(0, 0)), numberText(ours(0, 1)), numberText(ours(1, 1)), thesis});
}

ThesisLaboratory laboratoryOfThesis() {
  return {"4.4",
          {{{"0.085", "0.500"},
            {"0.110", "0.180"},
            {"0.085", "0.500"},
            {"22.7 %", "316.7 %"},
            {"0.107", "0.211"},
            {"2.7 %", "17.2 %"}}},
          {{0.04, 0.18}, {-0.2, 1.0}}};
}

}  // namespace

void tellPendulum(const MotionResult& found, const CommandContext& context, Summary& summary,
                  Report& report) {
  const MatrixXd &boundBefore = found.boundBefore, &boundAfter = found.boundAfter;
  const info::MonteCarloResult &slow = found.trialsBefore->result,
                               &fast = found.trialsAfter->result;
  const Eigen::VectorXd &truthBefore = found.trialsBefore->plan.truth,
                        &truthAfter = found.trialsAfter->plan.truth;
  const double factor = info::symmetricEigenvalues(boundBefore).maxCoeff() /
                        info::symmetricEigenvalues(boundAfter).maxCoeff();
  summary.set("bound_initial", rowsOf(boundBefore));
  summary.set("bound_optimised", rowsOf(boundAfter));
  summary.set("monte_carlo_initial", rowsOf(slow.covariance));
  summary.set("monte_carlo_optimised", rowsOf(fast.covariance));
  summary.set("lambda_min_factor", factor);
  summary.set("trials", slow.trials.size());
  summary.set("trials_converged", {{"initial", slow.converged}, {"optimised", fast.converged}});

  report.mainFigure = stateFigure("Motion", "Angle [rad]", found, {{"link 1", 1}, {"link 2", 2}});
  report.details.emplace_back(
      Section{"Information",
              "What one experiment tells of the parameters: bounds from the Fisher information, "
              "and estimates from simulated experiments, beside the numbers of Wilson's thesis."});
  Table table{.title = "Variances and covariance of the estimates from one experiment",
              .columns = {"", "m1 m1 [kg²]", "m1 c [kg·g m²/s]", "c c [(g m²/s)²]", "thesis"},
              .rows = {}};
  addRow(table, "Cramér–Rao bound, start", boundBefore, "2.71e-4, 1.46e-3, 1.05");
  addRow(table, "Cramér–Rao bound, optimised", boundAfter, "2.32e-7, 8.83e-7, 1.01e-3");
  addRow(table, "Monte Carlo, start", slow.covariance, "3.16e-4, 3.45e-3, 1.06");
  addRow(table, "Monte Carlo, optimised", fast.covariance, "2.37e-7, 1.63e-6, 1.19e-3");
  report.details.emplace_back(table);
  report.details.emplace_back(
      Table{.title = "Information about the least determined direction",
            .columns = {"", "here", "thesis"},
            .rows = {{"factor of λ_min", numberText(factor), "1040"},
                     {"iterations", std::to_string(found.search.iterations), "36"}}});
  report.details.emplace_back(informationFigure(found));
  report.details.emplace_back(
      Section{"Motion of the cart", "What the search changed; dashed lines are before it."});
  report.details.emplace_back(stateFigure("Cart", "Position [m]", found, {{"cart", 0}}));
  report.details.emplace_back(inputFigure("Cart acceleration [m/s²]", found));
  sayHistograms(report);
  report.details.emplace_back(histogram("m1 [kg], start", slow, 0, truthBefore[0]));
  report.details.emplace_back(histogram("m1 [kg], optimised", fast, 0, truthAfter[0]));
  report.details.emplace_back(histogram("c [g m²/s], start", slow, 1, truthBefore[1]));
  report.details.emplace_back(histogram("c [g m²/s], optimised", fast, 1, truthAfter[1]));
  if (found.laboratory)
    tellLaboratory(*found.laboratory, laboratoryOfThesis(), context, summary, report);
  report.verdict = fmt::format(
      "The optimised motion gives {} times as much information about the least determined "
      "direction; the standard deviation of m1 falls from {} to {} kg, that of c from {} to {} "
      "g m²/s.",
      numberText(factor), numberText(std::sqrt(boundBefore(0, 0)), 3),
      numberText(std::sqrt(boundAfter(0, 0)), 3), numberText(std::sqrt(boundBefore(1, 1)), 3),
      numberText(std::sqrt(boundAfter(1, 1)), 3));
}

}  // namespace app
