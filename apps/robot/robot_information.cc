#include "robot/robot_information.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "output/text.h"
#include "robot/robot_figures.h"
#include "robot/robot_search.h"
#include "robots/robot_information.h"

namespace app {
namespace {

using Eigen::MatrixXd;

std::vector<std::string> namesOf(const info::PlannedExperiment& experiment) {
  std::vector<std::string> names;
  for (const info::Parameter& parameter : experiment.parameters) names.push_back(parameter.name);
  return names;
}

// {"m1_m1": …, "m1_c": …, "c_c": …}
nlohmann::ordered_json upperTriangle(const MatrixXd& matrix,
                                     const std::vector<std::string>& names) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i; j < names.size(); ++j)
      json[names[i] + "_" + names[j]] =
          matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return json;
}

Table matrixTable(const std::string& title, const MatrixXd& matrix,
                  const info::PlannedExperiment& experiment) {
  Table table{.title = title, .columns = {""}, .rows = {}};
  for (const info::Parameter& parameter : experiment.parameters)
    table.columns.push_back(label(parameter));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    table.rows.push_back({table.columns[static_cast<std::size_t>(i) + 1]});
    for (double entry : matrix.row(i)) table.rows.back().push_back(numberText(entry));
  }
  return table;
}

// β of exact data within half and one and a half times the truth.
Figure basinAbout(const info::PlannedExperiment& plan, int threads) {
  const info::LeastSquares problem(
      plan.predictor, {plan.predictor.outputs(plan.truth), plan.covariance}, plan.parameters);
  std::vector<std::pair<double, double>> range;
  for (double truth : plan.truth) range.emplace_back(0.5 * truth, 1.5 * truth);
  return basinFigure({"Cost of the estimator on exact data", range, plan.truth}, problem, {},
                     threads);
}

void simulate(const CommandContext& context, const info::PlannedExperiment& plan, int trials,
              Summary& summary, Report& report) {
  WorkBars bars;
  const info::MonteCarloResult result = info::robot::simulateTrials(
      plan, trials, context.seed, context.threads, "trials", bars.progress());
  summary.set("trials", trials);
  summary.set("trials_converged", result.converged);
  summary.set("trials_covariance", upperTriangle(result.covariance, namesOf(plan)));
  report.details.emplace_back(
      Section{"Simulated experiments",
              "How estimates from simulated experiments scatter; their covariance should be about "
              "the bound."});
  report.details.emplace_back(Paragraph{
      fmt::format("{} simulated experiments with independent noise, each estimated from an initial "
                  "guess drawn between 0 and 2 times the true values; {} estimates converged.",
                  trials, result.converged)});
  report.details.emplace_back(matrixTable("Covariance of the estimates", result.covariance, plan));
}

}  // namespace

ExitStatus tellInformation(const info::PlannedExperiment& plan, std::optional<int> trials,
                           const CommandContext& context, Summary& summary, Report& report) {
  const std::vector<std::string> names = namesOf(plan);
  const info::robot::ExperimentInformation found = info::robot::informationOf(plan);
  const MatrixXd& matrix = found.information;
  const info::IdentifiabilityReport& verdict = found.identifiability;
  for (std::size_t i = 0; i < names.size(); ++i)
    summary.set("unit_" + names[i], plan.parameters[i].unit);
  summary.set("information", upperTriangle(matrix, names));
  summary.set("determined_directions", verdict.rank);
  summary.set("findings", verdict.sentences);
  report.details.emplace_back(
      Section{"Information",
              "What one experiment tells of the parameters; its inverse, where it exists, is the "
              "least covariance of unbiased estimates."});
  report.details.emplace_back(matrixTable("Fisher information", matrix, plan));
  if (verdict.rank < static_cast<Eigen::Index>(names.size())) {
    report.verdict = fmt::format("{}.", fmt::join(verdict.sentences, "; "));
    std::vector<std::string> directions;
    for (const auto& direction : verdict.undetermined) directions.push_back(direction.words);
    summary.set("undetermined_direction", fmt::format("{}", fmt::join(directions, "; ")));
    summary.set("determined", fmt::format("{}", fmt::join(verdict.determined, ", ")));
    report.mainFigure = basinAbout(plan, context.threads);
    return ExitStatus::answerIsNo;
  }

  const MatrixXd& bound = found.bound;
  const Eigen::VectorXd& eigenvalues = found.eigenvalues;
  summary.set("cramer_rao_bound", upperTriangle(bound, names));
  summary.set("least_eigenvalue", eigenvalues[0]);
  summary.set("condition_number", eigenvalues[eigenvalues.size() - 1] / eigenvalues[0]);
  std::vector<std::string> sds;
  for (std::size_t i = 0; i < names.size(); ++i)
    sds.push_back(fmt::format("{} to ±{} {}", names[i],
                              numberText(verdict.sd[static_cast<Eigen::Index>(i)], 3),
                              plan.parameters[i].unit));
  report.verdict = fmt::format("One experiment determines {} (Cramér–Rao standard deviations).",
                               fmt::join(sds, ", "));
  report.details.emplace_back(matrixTable("Cramér–Rao bound", bound, plan));
  if (trials) simulate(context, plan, *trials, summary, report);
  return ExitStatus::done;
}

}  // namespace app
