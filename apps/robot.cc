#include "robot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "info/convergence.h"
#include "info/fisher.h"
#include "info/identifiability.h"
#include "info/monte_carlo.h"
#include "info/systems/robot_experiments.h"
#include "progress_bar.h"
#include "result.h"
#include "robot_optimise.h"
#include "text.h"

namespace app {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::Method;

struct NamedMethod {
  Method method;
  std::string name;
  int maxIterations;
};
const std::vector<NamedMethod> kMethods = {
    {Method::gradientDescent, "gradient descent", 1000},
    {Method::iteratedLeastSquares, "iterated least squares", 100},
    {Method::newtonRaphson, "Newton-Raphson", 100}};

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

/// One estimator's way to the minimum.
struct Approach {
  std::string method;
  info::Estimate estimate;
  std::vector<info::ConvergenceRow> rows;
};

std::vector<Approach> approaches(const info::PlannedExperiment& experiment, const MatrixXd& data,
                                 const std::optional<VectorXd>& knownMinimum) {
  const info::LeastSquares problem(experiment.predictor, {data, experiment.covariance},
                                   experiment.parameters);
  info::EstimateOptions options;
  VectorXd minimum;
  if (knownMinimum) {
    minimum = *knownMinimum;
  } else {
    options.method = Method::newtonRaphson;
    options.decrementTolerance = 0;
    minimum = info::estimate(problem, experiment.truth, options).parameters;
    options = {};
  }
  std::vector<Approach> all;
  for (const NamedMethod& method : kMethods) {
    options.method = method.method;
    options.maxIterations = method.maxIterations;
    info::Estimate estimate = info::estimate(problem, options);
    auto rows = info::convergenceTable(estimate, minimum);
    all.push_back({method.name, std::move(estimate), std::move(rows)});
  }
  return all;
}

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
  Figure figure{.title = "Approach to the minimum",
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

class Robot : public Command {
 public:
  About about() const override {
    return {"robot", "The motion of a robot that tells most about its parameters",
            "fisherhill robot double-pendulum --discrete"};
  }

  void addOptions(CLI::App& options) override {
    options
        .add_option("ROBOT", robot_,
                    "double-pendulum (cart, two links, angles measured) or suspended-mass (cart, "
                    "mass on a string, its force measured)")
        ->required()
        ->check(CLI::IsMember({"double-pendulum", "suspended-mass"}))
        ->type_name("");
    options.add_flag("--discrete", discrete_,
                     "double-pendulum: optimise the variational integrator's motion in steps");
    options
        .add_option("--perturb", perturb_,
                    "add a small random smooth motion to the start, of about this input "
                    "[m/s^2; with --discrete m]")
        ->check(CLI::PositiveNumber)
        ->type_name("SIZE");
    options
        .add_option("--warm-start", warmStart_, "start from the input of a motion_optimised.csv")
        ->check(CLI::ExistingFile)
        ->type_name("FILE");
    options.add_flag("--as-is", asIs_, "judge the start, with simulated trials; do not optimise");
    options.add_flag("--bound-only", boundOnly_, "the Cramér-Rao bound, without simulated trials");
    options
        .add_option("--unknown", unknown_,
                    "double-pendulum: m1,c (mass and damping) or m1,m2 (both masses)")
        ->check(CLI::IsMember({"m1,c", "m1,m2"}))
        ->type_name("NAMES");
    options.add_flag("--undamped", undamped_, "double-pendulum with --unknown m1,m2: no damping");
    options
        .add_option("--amplitude", amplitude_, "cart motion amplitude*(1 - cos(2 pi t/period)) [m]")
        ->check(CLI::NonNegativeNumber)
        ->type_name("A");
    options.add_option("--period", period_, "its period [s]")
        ->check(CLI::PositiveNumber)
        ->type_name("T");
    options.add_option("--trials", trials_, "simulated experiments, each estimated (300)")
        ->check(CLI::PositiveNumber)
        ->type_name("N");
    options.add_flag("--convergence", convergence_,
                     "suspended-mass: how fast three estimators converge");
  }

  ExitStatus run(const CommandContext& context) override {
    const bool isPendulum = robot_ == "double-pendulum";
    if (convergence_ && isPendulum)
      throw std::invalid_argument("--convergence goes with suspended-mass");
    if (!isPendulum && (undamped_ || unknown_ != "m1,c"))
      throw std::invalid_argument("--unknown and --undamped go with double-pendulum");
    if (undamped_ && unknown_ != "m1,m2")
      throw std::invalid_argument("--undamped goes with --unknown m1,m2");
    const bool optimise = !convergence_ && !boundOnly_ && !asIs_ && unknown_ == "m1,c";
    if (!optimise && (discrete_ || perturb_ || !warmStart_.empty()))
      throw std::invalid_argument(
          "--discrete, --perturb and --warm-start go with optimising, without --as-is, "
          "--bound-only, --convergence and --unknown m1,m2");
    if (discrete_ && !isPendulum)
      throw std::invalid_argument("--discrete goes with double-pendulum");
    OutputFolder folder(context, optimise ? optimiseFiles() : std::vector<std::string>{});
    Summary summary(context);
    Report report;
    report.title = fmt::format("What the {} tells", robot_);
    const ExitStatus status = convergence_ ? convergence(context, summary, report)
                              : optimise   ? optimiseRobot({isPendulum, discrete_, amplitude_,
                                                            period_, perturb_, warmStart_, trials_},
                                                           context, summary, report, folder)
                                           : information(context, summary, report);
    deliver(context, summary, report, folder);
    return status;
  }

 private:
  info::PlannedExperiment experiment() const {
    using info::DoublePendulumUnknowns;
    if (robot_ == "suspended-mass")
      return info::suspendedMassExperiment(
          amplitude_ || period_
              ? info::cosineMotion(amplitude_.value_or(0.0476), period_.value_or(5), 5, 100, 1)
              : info::suspendedMassStart());
    const info::CartMotion motion =
        amplitude_ || period_
            ? info::cosineMotion(amplitude_.value_or(0.05), period_.value_or(5), 5, 30, 2)
            : info::doublePendulumStart();
    return unknown_ == "m1,c"
               ? info::doublePendulumExperiment(motion)
               : info::doublePendulumExperiment(motion, DoublePendulumUnknowns::bothMasses,
                                                undamped_ ? 0.0 : 5e-4);
  }

  ExitStatus information(const CommandContext& context, Summary& summary, Report& report) const {
    const info::PlannedExperiment plan = experiment();
    const std::vector<std::string> names = namesOf(plan);
    const MatrixXd matrix = info::fisherInformation(
        plan.predictor.withSensitivities(plan.truth).gamma, plan.covariance);
    std::vector<info::Parameter> atTruth = plan.parameters;
    for (std::size_t i = 0; i < atTruth.size(); ++i) {
      atTruth[i].start = plan.truth[static_cast<Eigen::Index>(i)];
      summary.set("unit_" + names[i], atTruth[i].unit);
    }
    const auto verdict = info::identifiability(matrix, atTruth);
    summary.set("information", upperTriangle(matrix, names));
    summary.set("determined_directions", verdict.rank);
    summary.set("findings", verdict.sentences);
    report.details.emplace_back(matrixTable("Fisher information", matrix, plan));
    if (verdict.rank < static_cast<Eigen::Index>(names.size())) {
      report.verdict = fmt::format("{}.", fmt::join(verdict.sentences, "; "));
      std::vector<std::string> directions;
      for (const auto& direction : verdict.undetermined) directions.push_back(direction.words);
      summary.set("undetermined_direction", fmt::format("{}", fmt::join(directions, "; ")));
      summary.set("determined", fmt::format("{}", fmt::join(verdict.determined, ", ")));
      return ExitStatus::answerIsNo;
    }

    const MatrixXd bound = info::cramerRaoBound(matrix, names);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(matrix, Eigen::EigenvaluesOnly);
    summary.set("cramer_rao_bound", upperTriangle(bound, names));
    summary.set("least_eigenvalue", eigen.eigenvalues()[0]);
    summary.set("condition_number",
                eigen.eigenvalues()[eigen.eigenvalues().size() - 1] / eigen.eigenvalues()[0]);
    std::vector<std::string> deviations;
    for (std::size_t i = 0; i < names.size(); ++i)
      deviations.push_back(fmt::format(
          "{} to ±{} {}", names[i], numberText(verdict.deviation[static_cast<Eigen::Index>(i)], 3),
          plan.parameters[i].unit));
    report.verdict = fmt::format("One run could determine {} (standard deviations).",
                                 fmt::join(deviations, ", "));
    report.details.emplace_back(matrixTable("Cramér–Rao bound", bound, plan));
    if (!boundOnly_) simulate(context, plan, summary, report);
    return ExitStatus::done;
  }

  void simulate(const CommandContext& context, const info::PlannedExperiment& plan,
                Summary& summary, Report& report) const {
    ProgressBar bar("trials");
    info::MonteCarloOptions options;
    options.trials = trials_;
    options.seed = context.seed;
    options.threads = context.threads;
    options.startSpread = 1;
    options.progress = [&](int done, int trials) {
      bar.update(static_cast<double>(done) / trials);
      return true;
    };
    const auto result =
        info::monteCarlo(plan.predictor, plan.truth, plan.covariance, plan.parameters, options);
    summary.set("trials", trials_);
    summary.set("trials_converged", result.converged);
    summary.set("trials_covariance", upperTriangle(result.covariance, namesOf(plan)));
    report.details.emplace_back(Paragraph{
        fmt::format("{} simulated experiments with fresh noise, each estimated from a start "
                    "drawn within 0 to 2 times the truth; {} estimates converged.",
                    trials_, result.converged)});
    report.details.emplace_back(
        matrixTable("Covariance of the estimates", result.covariance, plan));
  }

  ExitStatus convergence(const CommandContext& context, Summary& summary, Report& report) const {
    // the start as in the thesis, with exact data; then a livelier motion with one noisy recording
    const info::PlannedExperiment quiet = experiment();
    const auto slow =
        approaches(quiet, quiet.predictor.outputs(quiet.truth), std::optional(quiet.truth));
    const info::PlannedExperiment lively =
        info::suspendedMassExperiment(info::suspendedMassLively());
    const auto fast = approaches(lively, info::simulateMeasurement(lively, context.seed), {});
    const std::vector<Table> tables = {
        convergenceTableOf("Quiet start, exact data", slow),
        convergenceTableOf("Lively motion 0.1 m, 1.2 s, one recording with noise", fast)};
    for (const Table& table : tables) {
      if (!context.json) printTable(table);
      report.details.emplace_back(table);
    }
    const auto record = [&](const std::string& prefix, const std::vector<Approach>& all) {
      for (const Approach& approach : all) {
        std::string name = approach.method;
        for (char& c : name)
          if (c == ' ' || c == '-') c = '_';
        // over all iterations, since single steps of gradient descent zigzag
        const double meanRatio = std::pow(approach.rows.back().error / approach.rows.front().error,
                                          1.0 / std::max(1, approach.estimate.iterations));
        summary.set(prefix + name, {{"iterations", approach.estimate.iterations},
                                    {"converged", approach.estimate.converged},
                                    {"final_error", approach.rows.back().error},
                                    {"mean_ratio", meanRatio},
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
        "On the quiet start gradient descent {} {} iterations; iterated least squares needs {}, "
        "Newton-Raphson {}.",
        descent.converged ? "needs" : "has not converged after", descent.iterations,
        slow[1].estimate.iterations, slow[2].estimate.iterations);
    return ExitStatus::done;
  }

  std::string robot_;
  std::string unknown_ = "m1,c";
  std::string warmStart_;
  bool boundOnly_ = false, undamped_ = false, convergence_ = false, discrete_ = false,
       asIs_ = false;
  std::optional<double> amplitude_, period_, perturb_;
  int trials_ = 300;
};

}  // namespace

std::unique_ptr<Command> robotCommand() {
  return std::make_unique<Robot>();
}

}  // namespace app
