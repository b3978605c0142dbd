#include "bio/discovery/musculoskeletal_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/initial_speed.h"
#include "bio/analysis/inverse_dynamics.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/effects.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/trial_review.h"
#include "discovery/look_at.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A force on one coordinate, straight between nodes.
ExternalForce onOne(const std::vector<double>& nodes, const VectorXd& values, int freeIndex,
                    Index coordinates) {
  MatrixXd all = MatrixXd::Zero(values.size(), coordinates);
  all.col(freeIndex) = values;
  return {nodes, all};
}

/// Muscles whose record has a flat top in a trial that hides 1 % of its height or more.
std::vector<std::string> withFlatTops(const std::vector<Trial>& trials) {
  std::vector<std::string> muscles;
  for (const Trial& trial : trials) {
    for (std::size_t i = 0; i < trial.muscles.size(); ++i) {
      const Eigen::RowVectorXd record = trial.excitations.col(static_cast<Index>(i)).transpose();
      if (flatTops(trial.times, record).maxCoeff() > 0.01 * record.maxCoeff())
        muscles.push_back(trial.muscles[i]);
    }
  }
  return muscles;
}

/// There will be thousands of simulations.
SystemOptions withTables(SystemOptions arm) {
  arm.tabulatePaths = true;
  return arm;
}

}  // namespace

MusculoskeletalProblem::MusculoskeletalProblem(const Model& model, const SystemOptions& arm,
                                               const std::string& coordinate,
                                               std::vector<Trial> trials,
                                               MusculoskeletalProblemOptions options)
    : encompassing_(
          encompassingModel(model, withTables(arm), coordinate, options.without, options.formula)),
      options_(std::move(options)),
      quantities_(encompassing_.quantities()),
      nuisances_(encompassing_.nuisances()) {
  if (trials.empty()) throw std::invalid_argument("no trial is given, must have at least one");
  const auto positive = [](double value, const char* what) {
    if (!(value > 0 && std::isfinite(value))) {
      throw std::invalid_argument(fmt::format("{} = {}, must be > 0", what, value));
    }
  };
  positive(options_.latentSpacing, "spacing of the latent force");
  positive(options_.latentFloor, "floor of the latent force's scale");
  positive(options_.startSd, "standard deviation of the start");
  positive(options_.speedSd, "standard deviation of the start's speed");
  const Integrator integrator = options_.simulation.integrator;
  if (integrator != Integrator::variational && integrator != Integrator::variationalLeft) {
    throw std::invalid_argument("sensitivities: integrator must be vi or vi-left");
  }
  double lastStart = -HUGE_VAL, firstEnd = HUGE_VAL;
  for (const Trial& trial : trials) {
    lastStart = std::max(lastStart, trial.times[0]);
    firstEnd = std::min(firstEnd, trial.times[trial.times.size() - 1]);
  }
  encompassing_.trialsLast(lastStart, firstEnd);
  encompassing_.forget(unsaturated(encompassing_, withFlatTops(trials)));
  quantities_ = encompassing_.quantities();
  for (Trial& trial : trials) addTrial(withProxies(std::move(trial), encompassing_));
  latentLag_ = activationLag();
  separateWhatTrialsTellApart();
}

void MusculoskeletalProblem::addTrial(Trial trial) {
  const Coordinate& observed = encompassing_.coordinate();
  OfTrial one{std::move(trial), {}, {}, {}, {}, {}, {}, {}, 0, 0};
  for (const MeasuredMotion& motion : one.trial.measured) {
    if (motion.coordinate != observed.name) continue;
    if (options_.usableSeries) requireUsable(one.trial.file, motion);
    one.times.assign(motion.times.begin(), motion.times.end());
    one.measured = motion.values;
  }
  if (one.times.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: no measured value of '{}'", one.trial.file, observed.name));
  }
  one.excitation = excitationOf(one.trial, encompassing_.arm());
  one.external = externalForceOf(one.trial, encompassing_.arm());
  one.known = experimentalConditionsOf(one.trial, encompassing_);
  const double first = one.trial.times[0], last = one.times.back();
  const double intervals = std::max(1.0, std::ceil((last - first) / options_.latentSpacing - 1e-9));
  for (int k = 0; k <= static_cast<int>(intervals); ++k) {
    one.nodes.push_back(first + k * options_.latentSpacing);
  }
  one.heldMass = weightOfHeldMass(encompassing_, one.times, one.measured, one.nodes);
  const bool turns = observed.isRotation;
  const double length = turns ? 1 : 0.125;  // [m] that stand for a radian
  one.angle = addOwnQuantity("", {"", turns ? "rad" : "m", one.measured[0], observed.rangeMin,
                                  observed.rangeMax, options_.startSd * length, false});
  const double shown = std::abs(initialSpeedShown(one.times, one.measured, 0.3 * length));
  one.speed = addOwnQuantity(
      ".speed", {"", turns ? "rad/s" : "m/s", 0, turns ? -10.0 : -2.0, turns ? 10.0 : 2.0,
                 std::max(options_.speedSd * length, shown), false});
  trials_.push_back(std::move(one));
}

std::size_t MusculoskeletalProblem::addOwnQuantity(const char* what, Quantity quantity) {
  quantity.trial = static_cast<int>(trials_.size());
  quantity.name = fmt::format("trial{}.initial.{}{}", quantity.trial + 1,
                              encompassing_.coordinate().name, what);
  quantity.lower = std::min(quantity.lower, quantity.nominal);
  quantity.upper = std::max(quantity.upper, quantity.nominal);
  nuisances_.push_back(quantities_.size());
  quantities_.push_back(std::move(quantity));
  return quantities_.size() - 1;
}

void MusculoskeletalProblem::separateWhatTrialsTellApart() {
  // the arm answers a push at once, but late muscles late; a clock that is off shifts both
  const bool isPushed = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& one) {
    return std::any_of(one.trial.applied.begin(), one.trial.applied.end(), [&](const auto& push) {
      return push.coordinate == encompassing_.coordinate().name &&
             push.values.maxCoeff() > push.values.minCoeff();
    });
  });
  if (isPushed) encompassing_.separate("delay", "clock");
  // gravity's moment grows with a mass, that of a force on the hand does not
  const bool isLoaded = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& one) {
    return one.trial.known.massInHand != trials_.front().trial.known.massInHand;
  });
  if (isLoaded) encompassing_.separate("tilt", "handforce");
}

VectorXd MusculoskeletalProblem::timedForce(int trial, const VectorXd& values) const {
  return withTimedForces(of(trial), values, {});
}

VectorXd MusculoskeletalProblem::withTimedForces(const OfTrial& one, const VectorXd& values,
                                                 const VectorXd& latent) const {
  VectorXd sum = latent;
  for (const TimedForce& force : encompassing_.timedForces()) {
    const double size = values[static_cast<Index>(force.amplitude)];
    if (size == 0) continue;
    if (sum.size() == 0) sum = VectorXd::Zero(static_cast<Index>(one.nodes.size()));
    for (Index k = 0; k < sum.size(); ++k) {
      const double share = timedShare(one.nodes[static_cast<std::size_t>(k)],
                                      values[static_cast<Index>(force.time)], force.ends)
                               .value;
      sum[k] += size * share * (force.of == TimedForce::Of::mass ? one.heldMass[k] : 1.0);
    }
  }
  return sum;
}

MatrixXd MusculoskeletalProblem::timedDirections(const OfTrial& one, const VectorXd& values,
                                                 const std::vector<std::size_t>& wanted) const {
  MatrixXd nodes;
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    for (const TimedForce& force : encompassing_.timedForces()) {
      if (wanted[j] != force.amplitude && wanted[j] != force.time) continue;
      const auto rows = static_cast<Index>(one.nodes.size());
      if (nodes.size() == 0) nodes = MatrixXd::Zero(rows, static_cast<Index>(wanted.size()));
      const double size = values[static_cast<Index>(force.amplitude)];
      for (Index k = 0; k < rows; ++k) {
        const TimedShare share = timedShare(one.nodes[static_cast<std::size_t>(k)],
                                            values[static_cast<Index>(force.time)], force.ends);
        const double weight = force.of == TimedForce::Of::mass ? one.heldMass[k] : 1.0;
        nodes(k, static_cast<Index>(j)) =
            weight * (wanted[j] == force.amplitude ? share.value : size * share.inTime);
      }
    }
  }
  return nodes;
}

double MusculoskeletalProblem::activationLag() const {
  double sum = 0, count = 0;
  for (const OfTrial& one : trials_) {
    const auto& times = one.excitation.times();
    VectorXd u(one.excitation.numMuscles());
    std::size_t hint = 0;
    for (const double t : times) {
      one.excitation.at(t, hint, u);
      for (Index i = 0; i < u.size(); ++i) {
        sum += encompassing_.arm().muscles()[static_cast<std::size_t>(i)].activation.lag(u[i]);
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : 0;
}

ParameterCatalogue::Setting MusculoskeletalProblem::settingAt(
    const OfTrial& one, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  if (values.size() != static_cast<Index>(quantities_.size())) {
    throw std::invalid_argument(fmt::format("{} values for {} quantities, must be as many",
                                            values.size(), quantities_.size()));
  }
  const auto own = static_cast<Index>(encompassing_.quantities().size());
  ParameterCatalogue::Setting setting =
      encompassing_.settingAt(values.head(own) + one.known, wanted);
  const SensorLaw sensor = encompassing_.sensorAt(values);
  setting.start.q[encompassing_.freeIndex()] =
      (values[static_cast<Index>(one.angle)] - sensor.bias) / (1 + sensor.gain);
  setting.start.qDot[encompassing_.freeIndex()] = values[static_cast<Index>(one.speed)];
  return setting;
}

SimulationOptions MusculoskeletalProblem::simulationOf(const OfTrial& one, const VectorXd& latent,
                                                       const SensorLaw& sensor) const {
  SimulationOptions simulation = options_.simulation;
  simulation.startTime = one.trial.times[0];
  // a sensor may look behind the last sample
  simulation.duration =
      std::max(one.times.back(), sensor.measuredAt(one.times.back(), simulation.startTime)) -
      simulation.startTime;
  simulation.progress = {};
  simulation.externalForce = one.external;
  if (latent.size() == 0) return simulation;
  if (latent.size() != static_cast<Index>(one.nodes.size())) {
    throw std::invalid_argument(
        fmt::format("{} values of the latent force for {} nodes, must be as many", latent.size(),
                    one.nodes.size()));
  }
  simulation.externalForce =
      sum(simulation.externalForce, onOne(one.nodes, latent, encompassing_.freeIndex(),
                                          encompassing_.arm().skeleton().numCoordinates()));
  return simulation;
}

// The arm may have muscles that the base model switched off.
ExcitationSignal MusculoskeletalProblem::excitationFor(const OfTrial& one,
                                                       const MusculoskeletalSystem& arm) const {
  return arm.numMuscles() == encompassing_.arm().numMuscles() ? one.excitation
                                                              : excitationOf(one.trial, arm);
}

Trajectory MusculoskeletalProblem::simulate(const OfTrial& one, const VectorXd& values,
                                            const VectorXd& latent, double stepFactor,
                                            const Nudge* nudge) const {
  ParameterCatalogue::Setting setting = settingAt(one, values, {});
  SimulationOptions simulation =
      simulationOf(one, withTimedForces(one, values, latent), encompassing_.sensorAt(values));
  if (nudge) apply(*nudge, setting.model, simulation.externalForce);
  simulation.step *= stepFactor;
  const MusculoskeletalSystem arm = encompassing_.armOf(setting);
  return simulateSetting(arm, setting, excitationFor(one, arm), simulation);
}

VectorXd MusculoskeletalProblem::outputsOf(const OfTrial& one, const VectorXd& values,
                                           const VectorXd& latent, double stepFactor,
                                           const Nudge* nudge) const {
  VectorXd y = VectorXd::Constant(static_cast<Index>(one.times.size()), nan);
  Trajectory motion;
  try {
    motion = simulate(one, values, latent, stepFactor, nudge);
  } catch (const std::exception&) {
    return y;  // outside its domain
  }
  const SensorLaw sensor = encompassing_.sensorAt(values);
  const int c = encompassing_.freeIndex();
  const double begin = one.trial.times[0];
  const Lagged course = lagged(motion.time, motion.q.row(c), motion.qDot.row(c), sensor.lag);
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    const double t = one.times[i];
    const auto w = lookAt(motion.time, sensor.measuredAt(t, begin));
    if (!w) continue;
    y[static_cast<Index>(i)] =
        (1 + sensor.gain) * w->value(course.value.row(0), course.speed.row(0)) + sensor.bias +
        sensor.drift * (t - begin);
  }
  return y;
}

VectorXd MusculoskeletalProblem::outputs(int trial, const VectorXd& values,
                                         const VectorXd& latent) const {
  return outputsOf(of(trial), values, latent, 1, nullptr);
}

VectorXd MusculoskeletalProblem::refinedOutputs(int trial, const VectorXd& values) const {
  return outputsOf(of(trial), values, {}, 0.5, nullptr);
}

Trajectory MusculoskeletalProblem::motion(int trial, const VectorXd& values) const {
  return simulate(of(trial), values, {}, 1, nullptr);
}

Trajectory MusculoskeletalProblem::inverseDynamics(int trial, const VectorXd& values,
                                                   const Trajectory& motion) const {
  const OfTrial& one = of(trial);
  const ParameterCatalogue::Setting setting = settingAt(one, values, {});
  MusculoskeletalSystem system = encompassing_.armOf(setting);
  const ExcitationSignal driven =
      drivenExcitation(excitationFor(one, system), muscleNames(system), setting.mapping);
  return bio::inverseDynamics(
      std::move(system), driven, motion.time, motion.q,
      simulationOf(one, withTimedForces(one, values, {}), encompassing_.sensorAt(values)));
}

MusculoskeletalSystem MusculoskeletalProblem::armAt(int trial, const VectorXd& values) const {
  return encompassing_.armOf(settingAt(of(trial), values, {}));
}

TrialStart MusculoskeletalProblem::startAt(int trial, const VectorXd& values) const {
  const OfTrial& one = of(trial);
  const StartPoint start = settingAt(one, values, {}).start;
  return {one.trial.file, one.trial.sha256, encompassing_.coordinate().name,
          start.q[encompassing_.freeIndex()], start.qDot[encompassing_.freeIndex()]};
}

std::string MusculoskeletalProblem::failure(int trial, const VectorXd& values) const {
  try {
    return simulate(of(trial), values, {}, 1, nullptr).why;
  } catch (const std::exception& error) {
    return error.what();
  }
}

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predict(
    int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return predictWith(nullptr, trial, values, latent, wanted, latentToo);
}

std::unique_ptr<MusculoskeletalProblem::Simulation> MusculoskeletalProblem::simulated(
    int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  return simulatedWith(nullptr, trial, values, latent, wanted, latentToo);
}

MatrixXd MusculoskeletalProblem::inputs(int trial) const {
  const OfTrial& one = of(trial);
  MatrixXd values(static_cast<Index>(one.times.size()), one.excitation.numMuscles());
  std::size_t hint = 0;
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    one.excitation.at(one.times[i], hint, values.row(static_cast<Index>(i)).transpose());
  }
  return values;
}

std::vector<std::string> MusculoskeletalProblem::inputNames() const {
  return muscleNames(encompassing_.arm());
}

std::unique_ptr<info::discover::DiscoveryProblem> MusculoskeletalProblem::withFormula(
    const std::vector<info::discover::FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  MusculoskeletalProblemOptions options = options_;
  options.formula = terms;
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (std::find(kept.begin(), kept.end(), c) == kept.end())
      options.without.push_back(candidates()[c].id);
  }
  std::vector<Trial> trials;
  for (const OfTrial& one : trials_) trials.push_back(one.trial);
  auto widened = std::make_unique<MusculoskeletalProblem>(
      encompassing_.base(), encompassing_.armOptions(), encompassing_.coordinate().name,
      std::move(trials), std::move(options));
  if (!widened->encompassing().knows("formula")) return nullptr;
  return widened;
}

}  // namespace bio::discover
