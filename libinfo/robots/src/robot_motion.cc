#include "robots/robot_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "info/design/discrete_projection.h"
#include "info/design/projection.h"
#include "info/information/symmetric_eigen.h"
#include "info/probability/random_stream.h"
#include "robots/robot_designs.h"

namespace info::robot {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Inputs = std::vector<VectorXd>;

constexpr std::size_t kFlowStepsPerSample = 4;  // of 1/120 s at 30 Hz
constexpr double kFlowStep = 1.0 / (30 * kFlowStepsPerSample), kDiscreteStep = 0.02,
                 kMassStep = 0.01;  // [s]

/// Starts a search for these values of θ, from these inputs.
using Projector = std::function<std::unique_ptr<ProjectedMotion>(const std::vector<Vector2d>& theta,
                                                                 const Inputs& start)>;

void mustBeSound(const MotionRequest& r) {
  const auto must = [](bool holds, const std::string& rule) {
    if (!holds) throw std::invalid_argument(rule);
  };
  const auto value = [&](const char* what, const std::optional<double>& given, const char* unit,
                         bool mayBeZero) {
    must(!given || ((mayBeZero ? *given >= 0 : *given > 0) && std::isfinite(*given)),
         fmt::format("{}: {}{}, must be {} 0 and finite", what, given.value_or(0), unit,
                     mayBeZero ? "≥" : ">"));
  };
  value("amplitude", r.amplitude, " m", true);
  value("period", r.period, " s", false);
  value("perturb", r.perturb, "", false);
  value("tolerance", r.tolerance, "", true);
  must(!r.iterations || *r.iterations >= 0,
       fmt::format("iterations: {}, must be ≥ 0", r.iterations.value_or(0)));
  must(r.trials >= 1, fmt::format("trials: {}, must be ≥ 1", r.trials));
  must(r.stepsPerSample >= 1,
       fmt::format("steps between measurements: {}, must be ≥ 1", r.stepsPerSample));
  must(!r.discrete || r.pendulum, "a discrete motion: must be of the double pendulum");
  must(r.discrete || r.stepsPerSample == 1,
       "steps between measurements: must be of a discrete motion");
  must(!r.discrete || !r.laboratory, "laboratory: must not be with a discrete motion");
  must(r.candidates.empty() || r.robust, "candidates: must be of a robust search");
}

/// Sets the initial motion, and the objective, input weight and limits of the design.
/// @param amplitude the task's own [m]
Inputs prepare(const MotionRequest& request, MotionDesign& design, double step, double amplitude) {
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
  Inputs start = design.desiredInput;
  if (!request.warmStart.empty()) {
    if (request.warmStart.size() != start.size())
      throw std::invalid_argument(
          fmt::format("warm start: {} inputs, must be {}", request.warmStart.size(), start.size()));
    for (std::size_t k = 0; k < start.size(); ++k) {
      if (!std::isfinite(request.warmStart[k]))
        throw std::invalid_argument(
            fmt::format("warm start: input {} is {}, must be finite", k + 1, request.warmStart[k]));
      start[k][0] = request.warmStart[k];
    }
  }
  if (request.perturb) {
    RandomStream random(request.seed, 0);
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

TimedMotion timed(const ProjectedMotion& projection, double step) {
  const Index candidates = std::ssize(projection.informations());
  TimedMotion motion{step, {}, projection.motion().u, projection.informationOverTime()};
  for (const VectorXd& x : projection.motion().x) motion.x.push_back(x.head(x.size() / candidates));
  return motion;
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

/// One system, or several with different parameter values.
template <class System, class Make>
System systemAt(const std::vector<Vector2d>& theta, const Make& make) {
  if (theta.size() == 1) return make(theta.front());
  std::vector<System> all;
  for (const Vector2d& values : theta) all.push_back(make(values));
  return stack(std::move(all));
}

/// Runs the search; with `robust` also for θ alone.
MotionResult find(const MotionRequest& request, const Projector& project, const Vector2d& theta,
                  const MotionDesign& design, double step, const Inputs& start,
                  const SearchOptions& base) {
  SearchOptions options = base;
  if (request.tolerance) options.slopeTolerance = *request.tolerance;
  if (request.iterations) options.maxIterations = *request.iterations;
  const auto searchFor = [&](const std::vector<Vector2d>& candidates, const char* doing) {
    MotionResult found;
    const auto projection = project(candidates, start);
    found.before = timed(*projection, step);
    if (request.progress)
      options.progress = [&](const SearchProgress& p) {
        request.progress(doing, std::min(1.0, p.iteration / 30.0));
        return true;
      };
    const auto begin = std::chrono::steady_clock::now();
    found.search = search(*projection, options);
    found.secondsPerIteration =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() /
        std::max(1, found.search.iterations);
    found.after = timed(*projection, step);
    return found;
  };
  MotionResult found;
  if (!request.robust) {
    found = searchFor({theta}, "optimising");
  } else {
    RobustOutcome outcome;
    outcome.candidates = request.candidates.empty() ? candidatesAbout(theta) : request.candidates;
    const MotionResult nominal = searchFor({theta}, "optimising, nominal");
    found = searchFor(outcome.candidates, "optimising, robust");
    const auto leastOf = [&](const Inputs& inputs) {
      const auto projection = project(outcome.candidates, inputs);
      VectorXd least(Index(outcome.candidates.size()));
      for (std::size_t s = 0; s < outcome.candidates.size(); ++s)
        least[Index(s)] = symmetricEigenvalues(projection->informations()[s])[0];
      return least;
    };
    outcome.initial = leastOf(start);
    outcome.nominal = leastOf(nominal.after.u);
    outcome.robust = leastOf(found.after.u);
    found.robust = std::move(outcome);
  }
  found.design = design;
  return found;
}

std::vector<double> firstInputs(const TimedMotion& motion) {
  std::vector<double> inputs;
  for (const VectorXd& u : motion.u) inputs.push_back(u[0]);
  return inputs;
}

/// The cart's acceleration in a motion.
CartMotion cartMotion(const TimedMotion& motion, std::size_t stepsPerSample) {
  return {firstInputs(motion), motion.step, stepsPerSample};
}

/// Simulates trials of both motions.
void tryBoth(const MotionRequest& request, PlannedExperiment before, PlannedExperiment after,
             MotionResult& found) {
  const auto tried = [&](PlannedExperiment plan, const char* doing) {
    MonteCarloResult result = simulateTrials(plan, request.trials, request.seed, request.threads,
                                             doing, request.progress);
    return MotionTrials{std::move(plan), std::move(result)};
  };
  found.trialsBefore = tried(std::move(before), "trials, start");
  found.trialsAfter = tried(std::move(after), "trials, optimised");
  found.unknown = found.trialsBefore->plan.parameters;
}

/// Searches the motion of a task in continuous time.
/// @param system   of values of θ
/// @param amplitude the task's own [m]
template <class System>
MotionResult findFlow(const MotionRequest& request, FlowTask task, const System& system,
                      const Vector2d& theta, double step, double amplitude) {
  const Inputs start = prepare(request, task.design, step, amplitude);
  const auto project = [&](const std::vector<Vector2d>& at, const Inputs& from) {
    return std::make_unique<FlowProjection>(systemAt<ExtendedFlow>(at, system), task.design, from);
  };
  return find(request, project, theta, task.design, step, start, {.largestMove = 2});
}

void tryInLaboratory(const MotionRequest& request, const LaboratoryRobot& robot,
                     std::size_t stepsPerSample, MotionResult& found) {
  found.laboratory = compareInLaboratory(
      robot, *request.laboratory, cartMotion(found.before, stepsPerSample),
      cartMotion(found.after, stepsPerSample), request.seed, request.threads, request.progress);
}

MotionResult optimisePendulum(const MotionRequest& request) {
  MotionResult found = findFlow(request, doublePendulumFlowTask(kFlowStep), doublePendulumFlow,
                                Vector2d(0.085, 0.5), kFlowStep, 0.05);
  found.states = {"cart_m",       "angle1_rad",      "angle2_rad",
                  "cart_m_per_s", "rate1_rad_per_s", "rate2_rad_per_s"};
  PlannedExperiment before =
      doublePendulumExperiment(cartMotion(found.before, kFlowStepsPerSample));
  PlannedExperiment after = doublePendulumExperiment(cartMotion(found.after, kFlowStepsPerSample));
  found.boundBefore = boundOf(before);
  found.boundAfter = boundOf(after);
  tryBoth(request, std::move(before), std::move(after), found);
  if (request.laboratory)
    tryInLaboratory(request, doublePendulumInLaboratory(*request.laboratory), kFlowStepsPerSample,
                    found);
  return found;
}

MotionResult optimiseSteps(const MotionRequest& request) {
  const auto every = static_cast<std::size_t>(request.stepsPerSample);
  StepTask task = doublePendulumStepTask(kDiscreteStep, every);
  const Inputs start = prepare(request, task.design, kDiscreteStep, 0.01);
  const auto project = [&](const std::vector<Vector2d>& theta, const Inputs& from) {
    return std::make_unique<StepProjection>(
        systemAt<ExtendedStepMap>(
            theta,
            [&](const Vector2d& at) { return doublePendulumSteps(kDiscreteStep, 1e-2, at); }),
        task.design, from);
  };
  MotionResult found = find(request, project, Vector2d(0.085, 0.05), task.design, kDiscreteStep,
                            start, {.slopeTolerance = 0.01});
  found.states = {"angle1_rad", "angle2_rad", "momentum1_kg_m2_per_s", "momentum2_kg_m2_per_s"};
  found.boundBefore = found.search.informationStart.inverse();
  found.boundAfter = found.search.information.inverse();
  const auto planOf = [&](const TimedMotion& motion) {
    return doublePendulumStepExperiment(firstInputs(motion), motion.step, every);
  };
  tryBoth(request, planOf(found.before), planOf(found.after), found);
  return found;
}

// On exact data, from (0.10 kg, 0.60 m) to (0.12 kg, 0.50 m).
ExactEstimates exactEstimates(const MotionRequest& request, const PlannedExperiment& plan,
                              const char* doing) {
  const LeastSquares problem(plan.predictor, {plan.predictor.outputs(plan.truth), plan.covariance},
                             plan.parameters);
  const auto approach = [&](Method method) {
    EstimateOptions options{.method = method, .maxIterations = 1001, .costTolerance = 1e-6};
    if (request.progress)
      options.progress = [&](const EstimateProgress& p) {
        request.progress(doing, p.iteration / 1001.0);
        return true;
      };
    return estimate(problem, options);
  };
  return {problem, approach(Method::gradientDescent), approach(Method::iteratedLeastSquares)};
}

MotionResult optimiseMass(const MotionRequest& request) {
  MotionResult found = findFlow(request, suspendedMassFlowTask(kMassStep), suspendedMassFlow,
                                Vector2d(0.10, 0.60), kMassStep, 0.0476);
  found.states = {"cart_m", "angle_rad", "cart_m_per_s", "rate_rad_per_s"};
  found.boundBefore = found.search.informationStart.inverse();
  found.boundAfter = found.search.information.inverse();
  const PlannedExperiment before = suspendedMassExperiment(cartMotion(found.before, 1));
  found.unknown = before.parameters;
  found.exactBefore = exactEstimates(request, before, "estimating, start");
  found.exactAfter = exactEstimates(request, suspendedMassExperiment(cartMotion(found.after, 1)),
                                    "estimating, optimised");
  if (request.laboratory)
    tryInLaboratory(request, suspendedMassInLaboratory(*request.laboratory), 1, found);
  return found;
}

}  // namespace

std::size_t numInputs(const MotionRequest& request) {
  if (!request.pendulum) return suspendedMassFlowTask(kMassStep).design.desiredInput.size();
  return request.discrete ? doublePendulumStepTask(kDiscreteStep).design.desiredInput.size()
                          : doublePendulumFlowTask(kFlowStep).design.desiredInput.size();
}

MotionResult optimiseMotion(const MotionRequest& request) {
  mustBeSound(request);
  if (!request.pendulum) return optimiseMass(request);
  return request.discrete ? optimiseSteps(request) : optimisePendulum(request);
}

double secondsPerContinuousIteration(double step) {
  const FlowTask flow = doublePendulumFlowTask(step);
  const auto project = [&](const std::vector<Vector2d>&, const Inputs& from) {
    return std::make_unique<FlowProjection>(flow.system, flow.design, from);
  };
  return find({}, project, Vector2d(0.085, 0.5), flow.design, step, flow.design.desiredInput,
              {.maxIterations = 10, .largestMove = 2})
      .secondsPerIteration;
}

}  // namespace info::robot
