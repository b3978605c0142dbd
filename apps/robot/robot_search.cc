#include "robot/robot_search.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "bio/tables/file_error.h"
#include "bio/tables/table_file.h"
#include "info/probability/random_stream.h"
#include "output/json_text.h"
#include "output/progress_bar.h"
#include "output/text.h"
#include "robot/robot_figures.h"

namespace app {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

// The column `input` of a motion table.
Inputs readStart(const std::string& file, std::size_t count) {
  const bio::Table table = bio::readTable(file, bio::TableKind::any);
  if (!bio::hasColumn(table, "input"))
    throw bio::FileError(fmt::format("{}: has no column 'input', must have one", file));
  const VectorXd values = table.values.col(bio::columnIndex(table, "input"));
  Inputs inputs;
  for (Index k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k]))
      throw bio::FileError(
          fmt::format("{}: row {}: input is empty, must be a number", file, k + 1));
    inputs.push_back(VectorXd::Constant(1, values[k]));
  }
  if (inputs.size() != count)
    throw bio::FileError(
        fmt::format("{}: {} rows, must be {} for this time step", file, inputs.size(), count));
  return inputs;
}

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

nlohmann::ordered_json searchJson(const Found& found) {
  const info::SearchResult& s = found.search;
  const auto list = [](const VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  return {{"why_it_stopped", info::describe(s.why)},
          {"converged", s.converged},
          {"iterations", s.iterations},
          {"motions_tried", s.trials},
          {"costs", s.costs},
          {"slopes", s.slopes},
          {"steps", s.steps},
          {"eigenvalues_before", list(eigenvaluesOf(s.informationStart))},
          {"eigenvalues_after", list(eigenvaluesOf(s.information))},
          {"weights", found.weights}};
}

TimedMotion timed(const info::ProjectedMotion& projection, double step) {
  return {step, projection.motion().x, projection.motion().u, projection.informationOverTime()};
}

// θ, and each parameter alone ±30 %.
std::vector<Vector2d> candidatesAbout(const Vector2d& theta) {
  std::vector<Vector2d> all = {theta};
  for (Index i = 0; i < 2; ++i)
    for (double factor : {0.7, 1.3}) {
      all.push_back(theta);
      all.back()[i] *= factor;
    }
  return all;
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

}  // namespace

Inputs prepare(const OptimiseRequest& request, const CommandContext& context,
               info::MotionDesign& design, double step, double amplitude) {
  if (request.objective) design.information = *request.objective;
  if (request.inputWeight) design.inputWeight = MatrixXd::Constant(1, 1, *request.inputWeight);
  if (request.limits) {
    design.limits.lower = VectorXd::Constant(1, request.limits->first);
    design.limits.upper = VectorXd::Constant(1, request.limits->second);
  }
  if (request.robust) design.candidateRule = *request.robust;
  if (request.amplitude || request.period) {
    const double A = request.amplitude.value_or(amplitude),
                 w = 2 * std::numbers::pi / request.period.value_or(5);
    for (std::size_t k = 0; k < design.desiredInput.size(); ++k) {
      const double t = step * static_cast<double>(k);
      design.desiredInput[k][0] =
          request.discrete ? A * std::sin(w * t) : A * w * w * std::cos(w * t);
    }
  }
  Inputs start = request.warmStart.empty()
                     ? design.desiredInput
                     : readStart(request.warmStart, design.desiredInput.size());
  if (request.perturb) {
    info::RandomStream random(context.seed, 0);
    for (int wave = 1; wave <= 3; ++wave) {
      const double size = *request.perturb * random.normal() / 3;
      for (std::size_t k = 0; k < start.size(); ++k)
        start[k][0] += size * std::sin(std::numbers::pi * wave * static_cast<double>(k) /
                                       static_cast<double>(start.size() - 1));
    }
  }
  // the first input of a motion in steps is given
  if (request.discrete) start[0] = design.desiredInput[0];
  return start;
}

Found find(const OptimiseRequest& request, const Projector& project, const Vector2d& theta,
           const info::MotionDesign& design, double step, const Inputs& start,
           const info::SearchOptions& base) {
  info::SearchOptions options = base;
  if (request.tolerance) options.slopeTolerance = *request.tolerance;
  if (request.iterations) options.maxIterations = *request.iterations;
  const auto searchFor = [&](const std::vector<Vector2d>& candidates, const char* label) {
    Found found;
    const auto projection = project(candidates, start);
    found.before = timed(*projection, step);
    ProgressBar bar(label);
    options.progress = [&](const info::SearchProgress& p) {
      bar.update(std::min(1.0, p.iteration / 30.0));
      return true;
    };
    const auto begin = std::chrono::steady_clock::now();
    found.search = info::search(*projection, options);
    found.msPerIteration =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count() /
        std::max(1, found.search.iterations);
    found.after = timed(*projection, step);
    return found;
  };
  Found found;
  try {
    if (!request.robust) {
      found = searchFor({theta}, "optimising");
    } else {
      RobustOutcome outcome;
      outcome.candidates = request.candidates.empty() ? candidatesAbout(theta) : request.candidates;
      const Found nominal = searchFor({theta}, "optimising, nominal");
      found = searchFor(outcome.candidates, "optimising, robust");
      const auto leastOf = [&](const Inputs& inputs) {
        const auto projection = project(outcome.candidates, inputs);
        VectorXd least(Index(outcome.candidates.size()));
        for (std::size_t s = 0; s < outcome.candidates.size(); ++s)
          least[Index(s)] = eigenvaluesOf(projection->informations()[s])[0];
        return least;
      };
      outcome.initial = leastOf(start);
      outcome.nominal = leastOf(nominal.after.u);
      outcome.robust = leastOf(found.after.u);
      found.robust = std::move(outcome);
    }
  } catch (const info::NoInformation& e) {
    throw std::invalid_argument(fmt::format(
        "{}: --perturb 0.05 adds a small smooth motion, --amplitude a larger one", e.what()));
  }
  found.weights = weightsOf(design);
  return found;
}

namespace {

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

void tellSearch(const Found& found, const std::vector<std::string>& columns, Summary& summary,
                Report& report, OutputFolder& folder) {
  summary.set("step_s", found.after.step);
  summary.set("duration_s", found.after.step * static_cast<double>(found.after.x.size() - 1));
  summary.set("wall_s", 1e-3 * found.msPerIteration * std::max(1, found.search.iterations));
  summary.set("iterations", found.search.iterations);
  summary.set("ms_per_iteration", found.msPerIteration);
  summary.set("cost_initial", found.search.costs.front());
  summary.set("cost_optimised", found.search.costs.back());
  summary.set("why_it_stopped", info::describe(found.search.why));
  report.details.emplace_back(Section{"Progress of the search"});
  if (found.robust) tellRobust(*found.robust, summary, report);
  report.details.emplace_back(costFigure(found.search));
  folder.write("search.json",
               [&](std::ostream& out) { out << jsonText(searchJson(found), 2) << '\n'; });
  writeMotion(folder, "motion_initial.csv", found.before, columns);
  writeMotion(folder, "motion_optimised.csv", found.after, columns);
}

ExitStatus statusOf(const Found& found, Report& report) {
  if (found.search.iterations > 0 || found.search.converged) return ExitStatus::done;
  report.verdict =
      fmt::format("No progress: {}; the cost stays at {} with slope {} after {} trial motions.",
                  info::describe(found.search.why), numberText(found.search.costs.back()),
                  numberText(found.search.slopes.back()), found.search.trials);
  return ExitStatus::answerIsNo;
}

}  // namespace app
