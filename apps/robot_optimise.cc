#include "robot_optimise.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "info/fisher.h"
#include "info/monte_carlo.h"
#include "info/systems/robot_designs.h"
#include "info/systems/robot_experiments.h"
#include "progress_bar.h"
#include "text.h"

namespace app {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Inputs = std::vector<VectorXd>;

/// A motion in columns, whichever way of time it came from.
struct Motion {
  double step;
  std::vector<VectorXd> x;
  Inputs u;
};

/// A search with all that is told about it.
struct Found {
  Motion before, after;
  info::SearchResult search;
  double msPerIteration;
  nlohmann::ordered_json weights;
};

nlohmann::ordered_json rowsOf(const MatrixXd& matrix) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

VectorXd eigenvaluesOf(const MatrixXd& information) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(information).eigenvalues();
}

// The column `input` of a motion table.
Inputs readStart(const std::string& file, std::size_t count) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be read", file));
  std::string line;
  std::getline(stream, line);
  std::size_t column = 0, at = 0;
  bool found = false;
  std::stringstream header(line);
  for (std::string name; std::getline(header, name, ','); ++at)
    if (name == "input") {
      column = at;
      found = true;
    }
  if (!found) throw std::runtime_error(fmt::format("{}: line 1: no column named input", file));
  Inputs inputs;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    std::stringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= column; ++i) std::getline(cells, cell, ',');
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != 0 || !std::isfinite(value))
      throw std::runtime_error(
          fmt::format("{}: line {}: input is \"{}\", rule: a finite number", file, number, cell));
    inputs.push_back(VectorXd::Constant(1, value));
  }
  if (inputs.size() != count)
    throw std::runtime_error(
        fmt::format("{}: {} rows, rule: {} for this time step", file, inputs.size(), count));
  return inputs;
}

// The start: the task's own, another amplitude or period, another motion, a little perturbed.
template <class Design>
Inputs startOf(const OptimiseRequest& request, const CommandContext& context, Design& design,
               double step, double amplitude) {
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
  return start;
}

template <class Projection, class System, class Design>
Found find(System system, Design design, double step, Inputs start,
           const info::SearchOptions& base) {
  Found found;
  try {
    Projection projection(std::move(system), design, start);
    found.before = {step, projection.motion().x, projection.motion().u};
    ProgressBar bar("optimising");
    info::SearchOptions options = base;
    options.progress = [&](const info::SearchProgress& p) {
      bar.update(std::min(1.0, p.iteration / 30.0));
      return true;
    };
    const auto begin = std::chrono::steady_clock::now();
    found.search = info::search(projection, options);
    found.msPerIteration =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count() /
        std::max(1, found.search.iterations);
    found.after = {step, projection.motion().x, projection.motion().u};
  } catch (const info::NoInformation& e) {
    throw std::invalid_argument(fmt::format(
        "{}: --perturb 0.05 adds a small smooth motion, --amplitude a larger one", e.what()));
  }
  found.weights = {{"e", design.information.e},
                   {"a", design.information.a},
                   {"d", design.information.d},
                   {"condition", design.information.condition},
                   {"input", rowsOf(design.inputWeight)},
                   {"model_state", rowsOf(design.modelState.diagonal().transpose())},
                   {"model_input", rowsOf(design.modelInput)},
                   {"gain_state", rowsOf(design.gainState.diagonal().transpose())},
                   {"gain_input", rowsOf(design.gainInput)}};
  return found;
}

void writeMotion(OutputFolder& folder, const std::string& name, const Motion& motion,
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

Series curve(const std::string& name, const Motion& motion,
             const std::function<double(std::size_t)>& y, SeriesStyle style = SeriesStyle::line) {
  Series series{.name = name, .style = style};
  for (std::size_t k = 0; k < motion.x.size(); ++k) {
    series.x.push_back(motion.step * static_cast<double>(k));
    series.y.push_back(y(k));
  }
  return series;
}

Figure stateFigure(const std::string& title, const std::string& label, const Found& found,
                   const std::vector<std::pair<std::string, Index>>& states) {
  Figure figure{.title = title, .xLabel = "Time [s]", .yLabel = label};
  for (const auto& [name, index] : states) {
    const Index i = index;
    figure.series.push_back(curve(
        name + ", start", found.before, [&](std::size_t k) { return found.before.x[k][i]; },
        SeriesStyle::dashed));
    figure.series.push_back(curve(name + ", optimised", found.after,
                                  [&](std::size_t k) { return found.after.x[k][i]; }));
  }
  return figure;
}

Figure inputFigure(const std::string& label, const Found& found) {
  return {.title = "Input",
          .xLabel = "Time [s]",
          .yLabel = label,
          .series = {
              curve(
                  "start", found.before, [&](std::size_t k) { return found.before.u[k][0]; },
                  SeriesStyle::dashed),
              curve("optimised", found.after, [&](std::size_t k) { return found.after.u[k][0]; })}};
}

Figure costFigure(const info::SearchResult& search) {
  Series series{.name = "J"};
  for (std::size_t i = 0; i < search.costs.size(); ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(search.costs[i]);
  }
  return {.title = "Cost of the motion",
          .xLabel = "Iteration",
          .yLabel = "J [1]",
          .series = {series},
          .yScale = AxisScale::logarithmic};
}

// Estimates of one parameter, counted in bins about the truth, in standard deviations of the bound.
Figure histogram(const std::string& name, const info::MonteCarloResult& result, Index parameter,
                 double truth) {
  const double sigma = std::sqrt(result.bound(parameter, parameter));
  constexpr int bins = 24;
  std::vector<double> counts(bins, 0.0);
  double inside = 0;
  for (const info::MonteCarloTrial& trial : result.trials) {
    const double place = ((trial.parameters[parameter] - truth) / sigma + 4) / 8 * bins;
    if (!trial.converged || !(place >= 0 && place < bins)) continue;
    counts[static_cast<std::size_t>(place)] += 1;
    inside += 1;
  }
  Series bars{.name = "estimates"},
      bound{.name = "the bound's normal distribution", .style = SeriesStyle::dashed};
  for (int i = 0; i < bins; ++i) {
    const double low = -4 + 8.0 * i / bins, high = -4 + 8.0 * (i + 1) / bins,
                 mid = (low + high) / 2;
    for (double edge : {low, high}) {
      bars.x.push_back(truth + sigma * edge);
      bars.y.push_back(counts[static_cast<std::size_t>(i)]);
    }
    bound.x.push_back(truth + sigma * mid);
    bound.y.push_back(result.converged * 8.0 / bins * std::exp(-mid * mid / 2) /
                      std::sqrt(2 * std::numbers::pi));
  }
  return {.title = name,
          .xLabel = name,
          .yLabel = "Trials",
          .series = {bars, bound},
          .caption = fmt::format("{:.0f} of {} estimates lie within 4 standard deviations.", inside,
                                 result.converged)};
}

info::CartMotion cartMotion(const Motion& motion, std::size_t stepsPerSample) {
  info::CartMotion cart{{}, motion.step, stepsPerSample};
  for (const VectorXd& u : motion.u) cart.acceleration.push_back(u[0]);
  return cart;
}

MatrixXd boundOf(const info::PlannedExperiment& plan) {
  return info::cramerRaoBound(
      info::fisherInformation(plan.predictor.withSensitivities(plan.truth).gamma, plan.covariance));
}

void addRow(Table& table, const std::string& what, const MatrixXd& ours,
            const std::string& thesis) {
  table.rows.push_back(
      {what, numberText(ours(0, 0)), numberText(ours(0, 1)), numberText(ours(1, 1)), thesis});
}

void tellSearch(const Found& found, Summary& summary, Report& report, OutputFolder& folder) {
  summary.set("iterations", found.search.iterations);
  summary.set("ms_per_iteration", found.msPerIteration);
  summary.set("cost_initial", found.search.costs.front());
  summary.set("cost_optimised", found.search.costs.back());
  summary.set("why_it_stopped", info::describe(found.search.why));
  folder.write("search.json", [&](std::ostream& out) { out << searchJson(found).dump(2) << '\n'; });
  report.details.emplace_back(costFigure(found.search));
}

// "no" if nothing was gained, with the figures
ExitStatus statusOf(const Found& found, Report& report) {
  if (found.search.iterations > 0 || found.search.converged) return ExitStatus::done;
  report.verdict =
      fmt::format("No progress: {}; the cost stays at {}, its slope is {} after {} motions tried.",
                  info::describe(found.search.why), numberText(found.search.costs.back()),
                  numberText(found.search.slopes.back()), found.search.trials);
  return ExitStatus::answerIsNo;
}

constexpr std::size_t kStepsPerSample = 4;  // of 1/120 s at 30 Hz

ExitStatus pendulum(const OptimiseRequest& request, const CommandContext& context, Summary& summary,
                    Report& report, OutputFolder& folder) {
  const double step = 1.0 / (30 * kStepsPerSample);
  info::FlowTask task = info::doublePendulumFlowTask(step);
  Inputs start = startOf(request, context, task.design, step, 0.05);
  const Found found = find<info::FlowProjection>(task.system, task.design, step, std::move(start),
                                                 {.largestMove = 2});
  const auto before = info::doublePendulumExperiment(cartMotion(found.before, kStepsPerSample));
  const auto after = info::doublePendulumExperiment(cartMotion(found.after, kStepsPerSample));
  const MatrixXd boundBefore = boundOf(before), boundAfter = boundOf(after);
  const double factor =
      eigenvaluesOf(boundBefore).maxCoeff() / eigenvaluesOf(boundAfter).maxCoeff();
  summary.set("bound_initial", rowsOf(boundBefore));
  summary.set("bound_optimised", rowsOf(boundAfter));

  const auto simulate = [&](const info::PlannedExperiment& plan, const char* label) {
    ProgressBar bar(label);
    info::MonteCarloOptions options;
    options.trials = request.trials;
    options.seed = context.seed;
    options.threads = context.threads;
    options.startSpread = 1;
    options.progress = [&](int done, int trials) {
      bar.update(static_cast<double>(done) / trials);
      return true;
    };
    return info::monteCarlo(plan.predictor, plan.truth, plan.covariance, plan.parameters, options);
  };
  const auto slow = simulate(before, "trials, start"), fast = simulate(after, "trials, optimised");
  summary.set("monte_carlo_initial", rowsOf(slow.covariance));
  summary.set("monte_carlo_optimised", rowsOf(fast.covariance));
  summary.set("lambda_min_factor", factor);
  summary.set("trials", request.trials);
  summary.set("trials_converged", {{"initial", slow.converged}, {"optimised", fast.converged}});

  report.mainFigure =
      stateFigure("The motion", "Angle [rad]", found, {{"link 1", 1}, {"link 2", 2}});
  Table table{
      .title = "What one run tells, variances and covariance",
      .columns = {"", "m1 m1 [kg²]", "m1 c [kg·1e-3 kg m²/s]", "c c [(1e-3 kg m²/s)²]", "thesis"},
      .rows = {}};
  addRow(table, "Cramér–Rao bound, start", boundBefore, "2.71e-4, 1.46e-3, 1.05");
  addRow(table, "Cramér–Rao bound, optimised", boundAfter, "2.32e-7, 8.83e-7, 1.01e-3");
  addRow(table, "Monte Carlo, start", slow.covariance, "3.16e-4, 3.45e-3, 1.06");
  addRow(table, "Monte Carlo, optimised", fast.covariance, "2.37e-7, 1.63e-6, 1.19e-3");
  report.details.emplace_back(table);
  report.details.emplace_back(
      Table{.title = "Information about the worst direction",
            .columns = {"", "here", "thesis"},
            .rows = {{"factor of λ_min", numberText(factor), "1040"},
                     {"iterations", std::to_string(found.search.iterations), "36"}}});
  report.details.emplace_back(stateFigure("The cart", "Position [m]", found, {{"cart", 0}}));
  report.details.emplace_back(inputFigure("Cart acceleration [m/s²]", found));
  report.details.emplace_back(histogram("m1 [kg], start", slow, 0, before.truth[0]));
  report.details.emplace_back(histogram("m1 [kg], optimised", fast, 0, after.truth[0]));
  report.details.emplace_back(histogram("c [1e-3 kg m²/s], start", slow, 1, before.truth[1]));
  report.details.emplace_back(histogram("c [1e-3 kg m²/s], optimised", fast, 1, after.truth[1]));
  tellSearch(found, summary, report, folder);
  const std::vector<std::string> columns = {"cart_m",       "angle1_rad",      "angle2_rad",
                                            "cart_m_per_s", "rate1_rad_per_s", "rate2_rad_per_s"};
  writeMotion(folder, "motion_initial.csv", found.before, columns);
  writeMotion(folder, "motion_optimised.csv", found.after, columns);
  report.verdict = fmt::format(
      "The optimised motion tells {} times as much about the worst direction; the deviation of m1 "
      "falls from {} to {} kg, that of c from {} to {} 1e-3 kg m²/s.",
      numberText(factor), numberText(std::sqrt(boundBefore(0, 0)), 3),
      numberText(std::sqrt(boundAfter(0, 0)), 3), numberText(std::sqrt(boundBefore(1, 1)), 3),
      numberText(std::sqrt(boundAfter(1, 1)), 3));
  return statusOf(found, report);
}

ExitStatus pendulumInSteps(const OptimiseRequest& request, const CommandContext& context,
                           Summary& summary, Report& report, OutputFolder& folder) {
  const double step = 0.02;
  info::StepTask task = info::doublePendulumStepTask(step);
  Inputs start = startOf(request, context, task.design, step, 0.01);
  start[0] = task.design.desiredInput[0];
  const Found found = find<info::StepProjection>(task.system, task.design, step, std::move(start),
                                                 {.slopeTolerance = 0.01});
  const info::SearchResult& s = found.search;
  const VectorXd before = eigenvaluesOf(s.informationStart), after = eigenvaluesOf(s.information);
  summary.set("bound_initial", rowsOf(s.informationStart.inverse()));
  summary.set("bound_optimised", rowsOf(s.information.inverse()));
  summary.set("information_initial", rowsOf(s.informationStart));
  summary.set("information_optimised", rowsOf(s.information));
  summary.set("unit_c", "10e-3 kg m²/s");
  summary.set("lambda_min_factor", after[0] / before[0]);
  // as many steps in continuous time, for comparison
  info::FlowTask flow = info::doublePendulumFlowTask(step);
  const Inputs flowStart = flow.design.desiredInput;
  const Found continuous = find<info::FlowProjection>(flow.system, flow.design, step, flowStart,
                                                      {.maxIterations = 10, .largestMove = 2});
  summary.set("ms_per_iteration_continuous", continuous.msPerIteration);
  report.mainFigure =
      stateFigure("The motion", "Angle [rad]", found, {{"link 1", 0}, {"link 2", 1}});
  report.details.emplace_back(Table{
      .title = "Exact information of 250 steps of 0.02 s, c in 10e-3 kg m²/s",
      .columns = {"", "here", "thesis"},
      .rows = {
          {"λ_min, start", numberText(before[0]), "543"},
          {"λ_max, start", numberText(before[1]), "5950"},
          {"λ_min, optimised", numberText(after[0]), "7.34e4"},
          {"λ_max, optimised", numberText(after[1]), "6.91e6"},
          {"factor of λ_min", numberText(after[0] / before[0]), "135"},
          {"iterations", std::to_string(s.iterations), "2"},
          {"ms per iteration, in steps", numberText(found.msPerIteration, 3), "39900"},
          {"ms per iteration, continuous", numberText(continuous.msPerIteration, 3), "762500"}}});
  report.details.emplace_back(inputFigure("Cart position [m]", found));
  tellSearch(found, summary, report, folder);
  const std::vector<std::string> columns = {"angle1_rad", "angle2_rad", "momentum1_kg_m2_per_s",
                                            "momentum2_kg_m2_per_s"};
  writeMotion(folder, "motion_initial.csv", found.before, columns);
  writeMotion(folder, "motion_optimised.csv", found.after, columns);
  report.verdict = fmt::format(
      "The optimised motion tells {} times as much about the worst direction, found in {} "
      "iterations of {} ms (continuous time: {} ms).",
      numberText(after[0] / before[0]), s.iterations, numberText(found.msPerIteration, 3),
      numberText(continuous.msPerIteration, 3));
  return statusOf(found, report);
}

ExitStatus suspendedMass(const OptimiseRequest& request, const CommandContext& context,
                         Summary& summary, Report& report, OutputFolder& folder) {
  const double step = 0.01;
  info::FlowTask task = info::suspendedMassFlowTask(step);
  Inputs start = startOf(request, context, task.design, step, 0.0476);
  const Found found = find<info::FlowProjection>(task.system, task.design, step, std::move(start),
                                                 {.largestMove = 2});
  const VectorXd before = eigenvaluesOf(found.search.informationStart),
                 after = eigenvaluesOf(found.search.information);
  summary.set("condition_initial", before[1] / before[0]);
  summary.set("condition_optimised", after[1] / after[0]);
  summary.set("lambda_max_initial", before[1]);
  summary.set("lambda_max_optimised", after[1]);

  // estimators on exact data, from (0.10 kg, 0.60 m) to (0.12 kg, 0.50 m)
  const auto iterations = [](const Motion& motion, info::Method method) {
    const auto plan = info::suspendedMassExperiment(cartMotion(motion, 1));
    const info::LeastSquares problem(
        plan.predictor, {plan.predictor.outputs(plan.truth), plan.covariance}, plan.parameters);
    return info::estimate(problem, {.method = method, .maxIterations = 1001, .costTolerance = 1e-6})
        .iterations;
  };
  using info::Method;
  const int slow = iterations(found.before, Method::gradientDescent),
            fast = iterations(found.after, Method::gradientDescent),
            squaresSlow = iterations(found.before, Method::iteratedLeastSquares),
            squaresFast = iterations(found.after, Method::iteratedLeastSquares);
  summary.set("gradient_descent_iterations", {{"initial", slow}, {"optimised", fast}});
  summary.set("iterated_least_squares_iterations",
              {{"initial", squaresSlow}, {"optimised", squaresFast}});
  const auto count = [](int n) { return n > 1000 ? std::string("> 1000") : std::to_string(n); };
  report.mainFigure = stateFigure("The motion", "Angle [rad]", found, {{"string", 1}});
  report.details.emplace_back(
      Table{.title = "Start and optimised motion",
            .columns = {"", "start", "optimised", "thesis"},
            .rows = {{"κ", numberText(before[1] / before[0]), numberText(after[1] / after[0]),
                      "1.73e8 to 19.3"},
                     {"λ1", numberText(before[1]), numberText(after[1]), "3.18e6 to 3.63e6"},
                     {"λ2", numberText(before[0]), numberText(after[0]), "0.0184 to 1.88e5"},
                     {"iterations of gradient descent", count(slow), count(fast), "> 1000 to 27"},
                     {"iterations of iterated least squares", count(squaresSlow),
                      count(squaresFast), "5 to 3"}}});
  report.details.emplace_back(stateFigure("The cart", "Position [m]", found, {{"cart", 0}}));
  report.details.emplace_back(inputFigure("Cart acceleration [m/s²]", found));
  tellSearch(found, summary, report, folder);
  const std::vector<std::string> columns = {"cart_m", "angle_rad", "cart_m_per_s",
                                            "rate_rad_per_s"};
  writeMotion(folder, "motion_initial.csv", found.before, columns);
  writeMotion(folder, "motion_optimised.csv", found.after, columns);
  report.verdict = fmt::format(
      "The condition number of the information falls from {} to {}; gradient descent needs {} "
      "iterations instead of {}.",
      numberText(before[1] / before[0], 3), numberText(after[1] / after[0], 3), count(fast),
      count(slow));
  return statusOf(found, report);
}

}  // namespace

std::vector<std::string> optimiseFiles() {
  return {"motion_initial.csv", "motion_optimised.csv", "search.json"};
}

ExitStatus optimiseRobot(const OptimiseRequest& request, const CommandContext& context,
                         Summary& summary, Report& report, OutputFolder& folder) {
  if (!request.warmStart.empty()) summary.addInput(request.warmStart);
  if (!request.pendulum) return suspendedMass(request, context, summary, report, folder);
  return request.discrete ? pendulumInSteps(request, context, summary, report, folder)
                          : pendulum(request, context, summary, report, folder);
}

}  // namespace app
