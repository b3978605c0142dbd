#include "robot/robot_search.h"

#include <fmt/format.h>

#include <cmath>

#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "info/information/symmetric_eigen.h"
#include "output/json_text.h"
#include "output/text.h"
#include "robot/robot_figures.h"

namespace app {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using info::robot::RobustOutcome;

void writeMotion(OutputFolder& folder, const std::string& name, const TimedMotion& motion,
                 const std::vector<std::string>& columns) {
  folder.write(name, [&](std::ostream& out) {
    out << "time,input";
    for (const std::string& column : columns) out << ',' << column;
    out << '\n';
    for (std::size_t k = 0; k < motion.x.size(); ++k) {
      out << fmt::format("{:.10g},{:.17g}", motion.step * static_cast<double>(k), motion.u[k][0]);
      for (double value : motion.x[k]) out << fmt::format(",{:.17g}", value);
      out << '\n';
    }
  });
}

nlohmann::ordered_json weightsOf(const info::MotionDesign& design) {
  nlohmann::ordered_json json = {{"e", design.information.e},
                                 {"a", design.information.a},
                                 {"d", design.information.d},
                                 {"condition", design.information.condition},
                                 {"input", rowsOf(design.inputWeight)},
                                 {"model_state", rowsOf(design.modelState.diagonal().transpose())},
                                 {"model_input", rowsOf(design.modelInput)},
                                 {"gain_state", rowsOf(design.gainState.diagonal().transpose())},
                                 {"gain_input", rowsOf(design.gainInput)}};
  if (design.limits.lower.size() > 0)
    json["limits"] = {{"lower", design.limits.lower[0]},
                      {"upper", design.limits.upper[0]},
                      {"weight", design.limits.weight}};
  return json;
}

nlohmann::ordered_json searchJson(const MotionResult& found) {
  const info::SearchResult& s = found.search;
  const auto list = [](const VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  return {{"why_it_stopped", info::describe(s.why)},
          {"converged", s.converged},
          {"iterations", s.iterations},
          {"motions_tried", s.trials},
          {"costs", s.costs},
          {"slopes", s.slopes},
          {"steps", s.steps},
          {"eigenvalues_before", list(info::symmetricEigenvalues(s.informationStart))},
          {"eigenvalues_after", list(info::symmetricEigenvalues(s.information))},
          {"weights", weightsOf(found.design)}};
}

void tellRobust(const RobustOutcome& outcome, Summary& summary, Report& report) {
  Table table{.title = "Smallest eigenvalue of the information for each set of parameter values",
              .columns = {"θ", "start", "optimised for the first only", "optimised for all"},
              .rows = {}};
  nlohmann::ordered_json candidates = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < outcome.candidates.size(); ++s) {
    const Vector2d& theta = outcome.candidates[s];
    candidates.push_back({theta[0], theta[1]});
    table.rows.push_back({fmt::format("{}, {}", numberText(theta[0]), numberText(theta[1])),
                          numberText(outcome.initial[Index(s)]),
                          numberText(outcome.nominal[Index(s)]),
                          numberText(outcome.robust[Index(s)])});
  }
  table.rows.push_back({"worst", numberText(outcome.initial.minCoeff()),
                        numberText(outcome.nominal.minCoeff()),
                        numberText(outcome.robust.minCoeff())});
  report.details.emplace_back(table);
  const auto list = [](const VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  summary.set("candidates", candidates);
  summary.set("lambda_min_candidates", {{"initial", list(outcome.initial)},
                                        {"nominal", list(outcome.nominal)},
                                        {"robust", list(outcome.robust)}});
  summary.set("worst_lambda_min", {{"initial", outcome.initial.minCoeff()},
                                   {"nominal", outcome.nominal.minCoeff()},
                                   {"robust", outcome.robust.minCoeff()}});
}

}  // namespace

info::robot::WorkProgress WorkBars::progress() {
  return [this](const char* doing, double fraction) {
    const std::lock_guard lock(mutex_);
    if (doing_ != doing) {
      doing_ = doing;
      bar_.emplace(doing_);
    }
    bar_->update(fraction);
  };
}

std::vector<double> readInputs(const std::string& file, std::size_t count) {
  const bio::Table table = bio::readTable(file, bio::TableKind::any);
  if (!bio::hasColumn(table, "input"))
    throw bio::FileError(fmt::format("{}: has no column 'input', must have one", file));
  const VectorXd values = table.values.col(bio::columnIndex(table, "input"));
  for (Index k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw bio::FileError(
          fmt::format("{}: row {}: input is empty, must be a number", file, k + 1));
  if (values.size() != static_cast<Index>(count))
    throw bio::FileError(
        fmt::format("{}: {} rows, must be {} for this time step", file, values.size(), count));
  return {values.begin(), values.end()};
}

void tellSearch(const MotionResult& found, Summary& summary, Report& report, OutputFolder& folder) {
  summary.set("step_s", found.after.step);
  summary.set("duration_s", found.after.step * static_cast<double>(found.after.x.size() - 1));
  summary.set("wall_s", found.secondsPerIteration * std::max(1, found.search.iterations));
  summary.set("iterations", found.search.iterations);
  summary.set("ms_per_iteration", 1e3 * found.secondsPerIteration);
  summary.set("cost_initial", found.search.costs.front());
  summary.set("cost_optimised", found.search.costs.back());
  summary.set("why_it_stopped", info::describe(found.search.why));
  report.details.emplace_back(Section{
      "Progress of the search",
      "The cost that the search lowers, iteration by iteration; a flat end means that it found a "
      "minimum."});
  if (found.robust) tellRobust(*found.robust, summary, report);
  report.details.emplace_back(costFigure(found.search));
  folder.write("search.json",
               [&](std::ostream& out) { out << jsonText(searchJson(found), 2) << '\n'; });
  writeMotion(folder, "motion_initial.csv", found.before, found.states);
  writeMotion(folder, "motion_optimised.csv", found.after, found.states);
}

ExitStatus statusOf(const MotionResult& found, Report& report) {
  if (found.search.iterations > 0 || found.search.converged) return ExitStatus::done;
  report.verdict =
      fmt::format("No progress: {}; the cost stays at {} with slope {} after {} trial motions.",
                  info::describe(found.search.why), numberText(found.search.costs.back()),
                  numberText(found.search.slopes.back()), found.search.trials);
  return ExitStatus::answerIsNo;
}

}  // namespace app
