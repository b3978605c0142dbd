#include "robot/robot_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "output/text.h"
#include "robots/active_estimation.h"

namespace app {
namespace {

using info::robot::ExperimentRequest;
using info::robot::MotionRequest;
using info::robot::MotionResult;

std::vector<std::string> namesOf(const std::vector<info::Parameter>& parameters) {
  std::vector<std::string> names;
  for (const info::Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

void sayRobot(bool pendulum, const std::string& unknown, Methods& methods) {
  methods.say(Methods::Part::model,
              fmt::format("The robot is {} ({}); its unknown parameters are {}.",
                          pendulum ? "a cart with a double pendulum, whose absolute angles are "
                                     "measured"
                                   : "a cart with a mass on a string, whose force is measured",
                          citation(Publication::wilson), unknown),
              {Publication::wilson});
  methods.assume(
      "The robot moves in a plane and begins at rest, hanging down; measurement noise is "
      "independent and normal.");
}

/// "minimises 100/λ_min + 2 tr I⁻¹"
std::string objectiveOf(const info::InformationWeights& weights) {
  std::vector<std::string> terms;
  const auto add = [&](double weight, const char* term) {
    if (weight != 0) terms.push_back(numberText(weight) + term);
  };
  add(weights.e, "/λ_min");
  add(weights.a, " tr I⁻¹");
  add(weights.d, " (−ln det I)");
  add(weights.condition, " λ_max/λ_min");
  return terms.empty() ? "nothing of the information" : fmt::format("{}", fmt::join(terms, " + "));
}

void sayObjective(const MotionRequest& request, const MotionResult& found, Methods& methods) {
  const info::MotionDesign& design = found.design;
  methods.say(
      Methods::Part::inference,
      fmt::format(
          "The input, {}, minimises {} with I the Fisher information of the measurements and λ its "
          "eigenvalues, plus half of {} times the squared deviation from the initial input.",
          request.discrete ? "the cart's position" : "the cart's acceleration",
          objectiveOf(design.information), numberText(design.inputWeight(0, 0))));
  if (design.limits.lower.size() > 0) {
    methods.say(
        Methods::Part::inference,
        fmt::format("It is kept between {} and {} {} by a barrier function ({}).",
                    numberText(design.limits.lower[0]), numberText(design.limits.upper[0]),
                    request.discrete ? "m" : "m/s²", citation(Publication::hauserSaccon2006)),
        {Publication::hauserSaccon2006});
  }
  if (found.robust) {
    methods.say(Methods::Part::inference,
                fmt::format("The {} over {} sets of parameter values is optimised, not that of the "
                            "nominal values alone.",
                            *request.robust == info::RobustRule::worst ? "worst case" : "average",
                            found.robust->candidates.size()));
  }
}

void sayStart(const MotionRequest& request, Methods& methods) {
  std::vector<std::string> parts;
  if (!request.warmStart.empty()) parts.push_back("the input of an earlier result");
  if (request.amplitude || request.period) parts.push_back("a cosine of the size given");
  if (parts.empty()) parts.push_back("the initial motion of the thesis");
  std::string text = listed(parts);
  if (request.perturb) {
    text += fmt::format(", to which a small smooth random one of size {} (seed {}) was added",
                        numberText(*request.perturb), request.seed);
  }
  methods.say(Methods::Part::inference, fmt::format("The search begins with {}.", text));
}

void sayMonteCarlo(std::size_t trials, std::uint64_t seed, const char* motions, Methods& methods) {
  methods.say(Methods::Part::inference,
              fmt::format("{} experiments with independent noise were simulated {} (seed {}); the "
                          "parameters were estimated from each by least squares "
                          "(Levenberg–Marquardt) from a start drawn between 0 and 2 times the true "
                          "values.",
                          trials, motions, seed));
}

void sayLaboratory(const info::robot::LaboratoryComparison& laboratory, Methods& methods) {
  const info::LaboratoryEffects& effects = laboratory.effects;
  std::vector<std::string> parts;
  const auto add = [&](double size, const std::string& words) {
    if (size != 0) parts.push_back(words);
  };
  add(effects.outOfPlane,
      fmt::format("a start {} rad out of the plane", numberText(effects.outOfPlane, 3)));
  add(effects.dryFriction,
      fmt::format("dry friction of {} N m", numberText(effects.dryFriction, 3)));
  add(effects.controlLag, fmt::format("a lag of {} s", numberText(effects.controlLag, 3)));
  add(effects.controlNoise,
      fmt::format("a disturbance of {} m/s²", numberText(effects.controlNoise, 3)));
  add(effects.sensorCurvature, fmt::format("a sensor that is non-linear by {} %",
                                           numberText(100 * effects.sensorCurvature, 3)));
  add(effects.sensorStep,
      fmt::format("a sensor resolution of {}", numberText(effects.sensorStep, 3)));
  if (parts.empty()) return;
  methods.say(Methods::Part::data,
              fmt::format("{} recordings of either motion were simulated with effects that the "
                          "model lacks: {}.",
                          laboratory.recordings, listed(parts)));
}

std::string startText(const ExperimentRequest& request) {
  return request.amplitude || request.period
             ? std::string("The cart moves as a cosine of the size given")
             : std::string("The cart moves as the initial motion of the thesis");
}

}  // namespace

void sayMotion(const MotionRequest& request, const MotionResult& found, Methods& methods) {
  sayRobot(request.pendulum, listed(namesOf(found.unknown)), methods);
  methods.say(Methods::Part::simulation,
              request.discrete
                  ? fmt::format("Motions are simulated by a variational integrator ({}) with steps "
                                "of {} s and measured after {}.",
                                citation(Publication::wilson), numberText(found.before.step),
                                request.stepsPerSample == 1
                                    ? std::string("every step")
                                    : fmt::format("every {} of them", request.stepsPerSample))
                  : fmt::format("Motions are simulated by the classical Runge–Kutta method of "
                                "fourth order with steps of {} s.",
                                numberText(found.before.step)));
  sayObjective(request, found, methods);
  sayStart(request, methods);
  methods.say(
      Methods::Part::inference,
      fmt::format("It descends along exact gradients with the projection operator ({}), "
                  "whose gains are those of a linear-quadratic regulator, and Armijo's "
                  "rule for the step; it made {} ({}).",
                  citation(Publication::wilson), counted(found.search.iterations, "iteration"),
                  info::describe(found.search.why)));
  if (found.trialsBefore) {
    sayMonteCarlo(found.trialsBefore->result.trials.size(), request.seed,
                  "for the initial motion and for the optimised one", methods);
  }
  if (found.exactBefore) {
    methods.say(Methods::Part::inference,
                "Gradient descent and iterated least squares were compared on exact data of both "
                "motions.");
  }
  if (found.laboratory) sayLaboratory(*found.laboratory, methods);
}

void sayInformation(const ExperimentRequest& request, const info::PlannedExperiment& plan,
                    int trials, std::uint64_t seed, Methods& methods) {
  sayRobot(request.pendulum, listed(namesOf(plan.parameters)), methods);
  methods.say(
      Methods::Part::inference,
      fmt::format("{}, for {} s; the Fisher information I = Σ ΓᵀΣ⁻¹Γ is that of all samples "
                  "at the true values, with exact sensitivities Γ, and its inverse is the "
                  "Cramér–Rao bound.",
                  startText(request), numberText(info::robot::experimentDuration)));
  if (trials > 0) {
    sayMonteCarlo(static_cast<std::size_t>(trials), seed, "with this motion", methods);
  }
}

void sayConvergence(const ExperimentRequest& request, std::uint64_t seed, Methods& methods) {
  sayRobot(request.pendulum, "mass and length of the string", methods);
  methods.say(Methods::Part::inference,
              fmt::format("{}, with exact data; then one livelier motion was recorded with noise "
                          "(seed {}). Gradient descent, iterated least squares and Newton–Raphson "
                          "started from the same values; errors are relative to the minimum of the "
                          "cost.",
                          startText(request), seed));
}

void sayStringLength(const info::robot::StringLengthRequest& request,
                     const info::robot::StringLengthResult& found, Methods& methods) {
  methods.say(Methods::Part::model,
              fmt::format("A robot arm with compliant joints moves a mass of {} kg on a string of "
                          "{} m, whose force a load cell measures with a noise of {} N ({}).",
                          numberText(request.payload), numberText(request.trueLength),
                          numberText(request.noise), citation(Publication::wilson)),
              {Publication::wilson});
  if (request.disturbance > 0) {
    methods.say(
        Methods::Part::model,
        fmt::format("The top of the string is disturbed by an unmeasured acceleration of {} "
                    "m/s² (standard deviation).",
                    numberText(request.disturbance)));
  }
  methods.say(
      Methods::Part::inference,
      fmt::format("In {} of {} s from different initial lengths (seed {}), sequential "
                  "action control ({}) chose motions that are informative about the "
                  "length, with a weight of {} on the middle position; it {}.",
                  counted(found.trials.size(), "trial"), numberText(request.duration), request.seed,
                  citation(Publication::ansariMurphey2016), numberText(request.trackingWeight),
                  request.searchTime ? "may postpone an action to a better time" : "acts at once"),
      {Publication::ansariMurphey2016});
  methods.say(
      Methods::Part::inference,
      fmt::format("{} estimated every {} s by least squares of the force {}{}.",
                  request.estimateMass ? "Length and mass were" : "The length was",
                  numberText(info::kEstimatorPeriod),
                  request.window > 0 ? fmt::format("in the last {} s", numberText(request.window))
                                     : "since the start",
                  request.ignoreClipping ? std::string(", clipped samples counting as measurements")
                                         : fmt::format("; clipped samples count as censored ({})",
                                                       citation(Publication::tobin1958))),
      request.ignoreClipping ? std::vector<Publication>{} : std::vector{Publication::tobin1958});
  methods.say(Methods::Part::simulation,
              request.realTime
                  ? "Arm, receiver, estimator and controller ran in real time, each in "
                    "a thread of its own."
                  : "Arm, receiver, estimator and controller ran one after the other "
                    "in simulated time.");
  methods.assume("The string is taut and massless, and moves in a plane.");
}

}  // namespace app
