#include <fmt/format.h>

#include <variant>

#include "docstrings.h"
#include "info/information/symmetric_eigen.h"
#include "interruptible.h"
#include "robots/robot_motion.h"
#include "robots/robots.h"

namespace python {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using info::robot::MotionRequest;
using info::robot::MotionResult;

/// As rows.
MatrixXd rowsOf(const std::vector<VectorXd>& vectors) {
  if (vectors.empty()) return {};
  MatrixXd rows(std::ssize(vectors), vectors.front().size());
  for (Index k = 0; k < rows.rows(); ++k) rows.row(k) = vectors[static_cast<std::size_t>(k)];
  return rows;
}

VectorXd asVector(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), std::ssize(values));
}

py::array_t<double> stackOf(const std::vector<MatrixXd>& matrices) {
  return py::module_::import("numpy").attr("array")(py::cast(matrices));
}

std::vector<std::string> namesOf(const std::vector<info::Parameter>& parameters) {
  std::vector<std::string> names;
  for (const info::Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

std::vector<std::string> unitsOf(const std::vector<info::Parameter>& parameters) {
  std::vector<std::string> units;
  for (const info::Parameter& parameter : parameters) units.push_back(parameter.unit);
  return units;
}

py::object trialsOf(const info::MonteCarloResult& found) {
  std::vector<VectorXd> estimates;
  for (const info::MonteCarloTrial& trial : found.trials)
    if (trial.converged) estimates.push_back(trial.parameters);
  return results("trials"_a = found.trials.size(), "converged"_a = found.converged,
                 "mean"_a = found.mean, "covariance"_a = found.covariance,
                 "estimates"_a = rowsOf(estimates));
}

py::object motionOf(const info::robot::TimedMotion& motion) {
  VectorXd time(std::ssize(motion.x)), input(std::ssize(motion.x));
  for (Index k = 0; k < time.size(); ++k) {
    time[k] = motion.step * static_cast<double>(k);
    input[k] = motion.u[static_cast<std::size_t>(k)][0];
  }
  return results("time"_a = time, "input"_a = input, "states"_a = rowsOf(motion.x),
                 "information"_a = stackOf(motion.grown));
}

py::object robustOf(const MotionResult& found) {
  if (!found.robust) return py::none();
  std::vector<VectorXd> candidates(found.robust->candidates.begin(),
                                   found.robust->candidates.end());
  return results("candidates"_a = rowsOf(candidates), "initial"_a = found.robust->initial,
                 "nominal"_a = found.robust->nominal, "robust"_a = found.robust->robust);
}

py::object laboratoryOf(const MotionResult& found) {
  if (!found.laboratory) return py::none();
  const info::robot::LaboratoryComparison& lab = *found.laboratory;
  return results("recordings"_a = lab.recordings, "truth"_a = VectorXd(lab.truth),
                 "start"_a = VectorXd(lab.start), "estimate_before"_a = lab.before.first.parameters,
                 "estimate_after"_a = lab.after.first.parameters,
                 "median_error_before"_a = VectorXd(lab.before.medianError),
                 "median_error_after"_a = VectorXd(lab.after.medianError));
}

py::object exactOf(const std::optional<info::robot::ExactEstimates>& exact) {
  if (!exact) return py::none();
  return py::cast(std::map<std::string, int>{
      {"gradient descent", exact->gradientDescent.iterations},
      {"iterated least squares", exact->iteratedLeastSquares.iterations}});
}

info::InformationWeights weightsFrom(const std::map<std::string, double>& objective) {
  info::InformationWeights weights;
  for (const auto& [name, weight] : objective) {
    if (name == "e") {
      weights.e = weight;
    } else if (name == "a") {
      weights.a = weight;
    } else if (name == "d") {
      weights.d = weight;
    } else if (name == "condition") {
      weights.condition = weight;
    } else {
      throw std::invalid_argument(
          fmt::format("objective: criterion '{}', must be e, a, d or condition", name));
    }
  }
  return weights;
}

/// Effects of the laboratory by name, or True for those of usual size.
std::optional<info::LaboratoryEffects> laboratoryFrom(
    const std::variant<bool, std::map<std::string, double>>& lab, bool pendulum) {
  if (const bool* usual = std::get_if<bool>(&lab)) {
    if (!*usual) return {};
    return pendulum ? info::usualDoublePendulumEffects() : info::usualSuspendedMassEffects();
  }
  info::LaboratoryEffects effects;
  const std::map<std::string, double*> sizes = {
      {"out_of_plane", &effects.outOfPlane},          {"dry_friction", &effects.dryFriction},
      {"control_lag", &effects.controlLag},           {"control_noise", &effects.controlNoise},
      {"sensor_curvature", &effects.sensorCurvature}, {"sensor_step", &effects.sensorStep}};
  for (const auto& [name, size] : std::get<std::map<std::string, double>>(lab)) {
    const auto found = sizes.find(name);
    if (found == sizes.end())
      throw std::invalid_argument(
          fmt::format("lab: '{}', must be out_of_plane, dry_friction, control_lag, control_noise, "
                      "sensor_curvature or sensor_step",
                      name));
    *found->second = size;
  }
  return effects;
}

bool isPendulum(const std::string& robot) {
  if (robot == "double-pendulum") return true;
  if (robot == "suspended-mass") return false;
  throw std::invalid_argument(
      fmt::format("robot '{}', must be double-pendulum or suspended-mass", robot));
}

MotionResult optimised(MotionRequest& request) {
  MotionResult found;
  interruptible([&](const std::atomic<bool>& goOn) {
    request.progress = whileTrue(goOn);
    try {
      found = info::robot::optimiseMotion(request);
    } catch (const info::NoInformation& e) {
      throw std::invalid_argument(fmt::format(
          "{}: perturb=0.05 adds a small smooth motion, amplitude a larger one", e.what()));
    }
  });
  return found;
}

py::object optimiseRobotMotion(const std::string& robot, bool discrete,
                               std::optional<double> amplitude, std::optional<double> period,
                               std::optional<double> perturb,
                               const std::optional<VectorXd>& warmStart,
                               const std::optional<std::map<std::string, double>>& objective,
                               std::optional<double> inputWeight,
                               std::optional<std::pair<double, double>> limits,
                               std::optional<double> tolerance, std::optional<int> iterations,
                               const std::optional<std::string>& robust,
                               const std::vector<std::pair<double, double>>& candidates,
                               int measureEvery,
                               const std::variant<bool, std::map<std::string, double>>& lab,
                               int trials, std::uint64_t seed, int threads) {
  MotionRequest request;
  request.pendulum = isPendulum(robot);
  request.discrete = discrete;
  request.amplitude = amplitude;
  request.period = period;
  request.perturb = perturb;
  if (warmStart) request.warmStart.assign(warmStart->begin(), warmStart->end());
  if (objective) request.objective = weightsFrom(*objective);
  request.inputWeight = inputWeight;
  request.limits = limits;
  request.tolerance = tolerance;
  request.iterations = iterations;
  request.stepsPerSample = measureEvery;
  if (robust && *robust != "worst" && *robust != "average")
    throw std::invalid_argument(fmt::format("robust '{}', must be worst or average", *robust));
  if (robust)
    request.robust = *robust == "worst" ? info::RobustRule::worst : info::RobustRule::average;
  for (const auto& [first, second] : candidates) request.candidates.emplace_back(first, second);
  request.laboratory = laboratoryFrom(lab, request.pendulum);
  request.trials = trials;
  request.seed = seed;
  request.threads = threads;
  const MotionResult found = optimised(request);
  const info::SearchResult& search = found.search;
  const auto tried = [](const std::optional<info::robot::MotionTrials>& done) {
    return done ? trialsOf(done->result) : py::none();
  };
  return results("names"_a = namesOf(found.unknown), "units"_a = unitsOf(found.unknown),
                 "state_names"_a = found.states, "before"_a = motionOf(found.before),
                 "after"_a = motionOf(found.after), "iterations"_a = search.iterations,
                 "motions_tried"_a = search.trials, "converged"_a = search.converged,
                 "why"_a = info::describe(search.why), "costs"_a = asVector(search.costs),
                 "slopes"_a = asVector(search.slopes), "steps"_a = asVector(search.steps),
                 "information_before"_a = search.informationStart,
                 "information_after"_a = search.information, "bound_before"_a = found.boundBefore,
                 "bound_after"_a = found.boundAfter, "trials_before"_a = tried(found.trialsBefore),
                 "trials_after"_a = tried(found.trialsAfter),
                 "estimator_iterations_before"_a = exactOf(found.exactBefore),
                 "estimator_iterations_after"_a = exactOf(found.exactAfter),
                 "robust"_a = robustOf(found), "laboratory"_a = laboratoryOf(found));
}

py::object robotInformation(const std::string& robot, std::optional<double> amplitude,
                            std::optional<double> period, const std::vector<std::string>& unknown,
                            bool undamped, int trials, std::uint64_t seed, int threads) {
  info::robot::ExperimentRequest request;
  request.pendulum = isPendulum(robot);
  request.amplitude = amplitude;
  request.period = period;
  const bool masses = unknown == std::vector<std::string>{"m1", "m2"};
  if (!unknown.empty() && !masses && unknown != std::vector<std::string>{"m1", "c"})
    throw std::invalid_argument("unknown: must be ['m1', 'c'] or ['m1', 'm2']");
  if (!unknown.empty() && !request.pendulum)
    throw std::invalid_argument("unknown: must be with 'double-pendulum'");
  request.bothMasses = masses;
  request.undamped = undamped;
  if (trials < 0) throw std::invalid_argument(fmt::format("trials = {}, must be ≥ 0", trials));
  const info::PlannedExperiment plan = info::robot::plannedExperiment(request);
  info::robot::ExperimentInformation found;
  py::object simulated = py::none();
  info::MonteCarloResult monteCarlo;
  interruptible([&](const std::atomic<bool>& goOn) {
    found = info::robot::informationOf(plan);
    if (trials > 0 && found.bound.size() > 0)
      monteCarlo =
          info::robot::simulateTrials(plan, trials, seed, threads, "trials", whileTrue(goOn));
  });
  if (trials > 0 && found.bound.size() > 0) simulated = trialsOf(monteCarlo);
  const info::IdentifiabilityReport& verdict = found.identifiability;
  std::vector<std::string> directions;
  for (const auto& direction : verdict.undetermined) directions.push_back(direction.words);
  return results("names"_a = namesOf(plan.parameters), "units"_a = unitsOf(plan.parameters),
                 "truth"_a = plan.truth, "information"_a = found.information,
                 "bound"_a = found.bound.size() > 0 ? py::cast(found.bound) : py::none(),
                 "eigenvalues"_a = found.eigenvalues, "determined_directions"_a = verdict.rank,
                 "sentences"_a = verdict.sentences, "determined"_a = verdict.determined,
                 "undetermined_directions"_a = directions, "trials"_a = simulated);
}

py::list approachesOf(const std::vector<info::robot::EstimatorConvergence>& all) {
  py::list list;
  for (const info::robot::EstimatorConvergence& convergence : all) {
    MatrixXd rows(std::ssize(convergence.rows), 4);
    for (Index k = 0; k < rows.rows(); ++k) {
      const info::ConvergenceRow& row = convergence.rows[static_cast<std::size_t>(k)];
      rows.row(k) << row.cost, row.error, row.ratio, row.order;
    }
    list.append(
        results("method"_a = convergence.method, "iterations"_a = convergence.estimate.iterations,
                "converged"_a = convergence.estimate.converged,
                "parameters"_a = convergence.estimate.parameters, "cost"_a = VectorXd(rows.col(0)),
                "error"_a = VectorXd(rows.col(1)), "ratio"_a = VectorXd(rows.col(2)),
                "order"_a = VectorXd(rows.col(3)), "mean_ratio"_a = convergence.meanRatio));
  }
  return list;
}

py::object compareRobotEstimators(std::optional<double> amplitude, std::optional<double> period,
                                  std::uint64_t seed) {
  const info::PlannedExperiment quiet =
      info::robot::plannedExperiment({.pendulum = false, .amplitude = amplitude, .period = period});
  info::robot::ConvergenceComparison found;
  interruptible([&](const std::atomic<bool>& goOn) {
    found = info::robot::compareEstimators(quiet, seed, whileTrue(goOn));
  });
  return results("quiet"_a = approachesOf(found.quiet), "lively"_a = approachesOf(found.lively));
}

}  // namespace

info::robot::WorkProgress whileTrue(const std::atomic<bool>& goOn) {
  return [&goOn](const char*, double) {
    if (!goOn) throw std::runtime_error("stopped");
  };
}

void defineRobotMotions(py::module_& module) {
  module.def("robot_information", &robotInformation, "robot"_a, py::kw_only(),
             "amplitude"_a = py::none(), "period"_a = py::none(),
             "unknown"_a = std::vector<std::string>(), "undamped"_a = false, "trials"_a = 0,
             "seed"_a = 1, "threads"_a = 1, docstrings::robot_information);
  module.def("optimise_robot_motion", &optimiseRobotMotion, "robot"_a, py::kw_only(),
             "discrete"_a = false, "amplitude"_a = py::none(), "period"_a = py::none(),
             "perturb"_a = py::none(), "warm_start"_a = py::none(), "objective"_a = py::none(),
             "input_weight"_a = py::none(), "limits"_a = py::none(), "tolerance"_a = py::none(),
             "iterations"_a = py::none(), "robust"_a = py::none(),
             "candidates"_a = std::vector<std::pair<double, double>>(), "measure_every"_a = 1,
             "lab"_a = false, "trials"_a = 300, "seed"_a = 1, "threads"_a = 1,
             docstrings::optimise_robot_motion);
  module.def("compare_robot_estimators", &compareRobotEstimators, py::kw_only(),
             "amplitude"_a = py::none(), "period"_a = py::none(), "seed"_a = 1,
             docstrings::compare_robot_estimators);
}

}  // namespace python
