#include "robot/robot_information.h"

#include <fmt/format.h>

#include "output/text.h"
#include "robots/robot_information.h"

namespace app {
namespace {

using Approach = info::robot::EstimatorConvergence;

// All rows of a short approach; of a long one the first six and the last four.
std::vector<info::ConvergenceRow> shownRows(const std::vector<info::ConvergenceRow>& rows) {
  std::vector<info::ConvergenceRow> shown;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows.size() <= 12 || k < 6 || k + 4 >= rows.size()) shown.push_back(rows[k]);
  return shown;
}

Table convergenceTableOf(const std::string& title, const std::vector<Approach>& all) {
  Table table{.title = title,
              .columns = {"estimator", "iteration", "cost", "relative error", "ratio", "order"},
              .rows = {}};
  for (const Approach& approach : all)
    for (const info::ConvergenceRow& row : shownRows(approach.rows))
      table.rows.push_back({approach.method, std::to_string(row.iteration), numberText(row.cost),
                            numberText(row.error), numberText(row.ratio, 3),
                            numberText(row.order, 3)});
  return table;
}

void printTable(const Table& table) {
  fmt::print("{}\n", table.title);
  fmt::print("{:<24}{:>10}{:>13}{:>16}{:>10}{:>10}\n", table.columns[0], table.columns[1],
             table.columns[2], table.columns[3], table.columns[4], table.columns[5]);
  for (const auto& row : table.rows)
    fmt::print("{:<24}{:>10}{:>13}{:>16}{:>10}{:>10}\n", row[0], row[1], row[2], row[3], row[4],
               row[5]);
  fmt::print("\n");
}

Figure errorFigure(const std::vector<Approach>& all) {
  Figure figure{.title = "Convergence to the minimum",
                .xLabel = "Iteration",
                .yLabel = "Relative error [1]",
                .series = {},
                .caption = "A straight line is linear convergence; one that bends down is faster.",
                .yScale = AxisScale::logarithmic};
  for (const Approach& approach : all) {
    Series series{.name = approach.method};
    for (const info::ConvergenceRow& row : approach.rows) {
      if (row.iteration > 60) break;
      series.x.push_back(row.iteration);
      series.y.push_back(row.error);
    }
    figure.series.push_back(std::move(series));
  }
  return figure;
}

}  // namespace

ExitStatus tellConvergence(const info::PlannedExperiment& quiet, const CommandContext& context,
                           Summary& summary, Report& report) {
  const info::robot::ConvergenceComparison found =
      info::robot::compareEstimators(quiet, context.seed);
  const std::vector<Approach>&slow = found.quiet, &fast = found.lively;
  const std::vector<Table> tables = {
      convergenceTableOf("Quiet initial motion, exact data", slow),
      convergenceTableOf("Lively motion 0.1 m, 1.2 s, one recording with noise", fast)};
  report.details.emplace_back(
      Section{"Iterations",
              "The way of each estimator to the minimum: a constant ratio of errors is linear "
              "convergence, an order near 2 quadratic."});
  for (const Table& table : tables) {
    if (!context.json) printTable(table);
    report.details.emplace_back(table);
  }
  const auto record = [&](const std::string& prefix, const std::vector<Approach>& all) {
    for (const Approach& approach : all) {
      std::string name = approach.method;
      for (char& c : name)
        if (c == ' ' || c == '-') c = '_';
      summary.set(prefix + name, {{"iterations", approach.estimate.iterations},
                                  {"converged", approach.estimate.converged},
                                  {"final_error", approach.rows.back().error},
                                  {"mean_ratio", approach.meanRatio},
                                  {"final_ratio", approach.rows.back().ratio}});
      if (approach.method == "Newton-Raphson")
        summary.set(prefix + name + "_final_order", approach.rows.back().order);
    }
  };
  record("quiet_", slow);
  record("lively_", fast);
  report.mainFigure = errorFigure(fast);
  const info::Estimate& descent = slow[0].estimate;
  report.verdict = fmt::format(
      "For the quiet initial motion gradient descent {} {} iterations; iterated least squares "
      "needs {}, Newton-Raphson {}.",
      descent.converged ? "needs" : "has not converged after", descent.iterations,
      slow[1].estimate.iterations, slow[2].estimate.iterations);
  return ExitStatus::done;
}

}  // namespace app
