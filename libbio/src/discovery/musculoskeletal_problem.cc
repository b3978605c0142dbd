#include "bio/discovery/musculoskeletal_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bio/analysis/replay.h"
#include "bio/discovery/effects.h"
#include "bio/discovery/with_experimental_conditions.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/trial_review.h"
#include "discovery/initial_speed.h"
#include "simulation/motion_weights.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Where the coordinate is looked at: before the start it goes on with its first speed.
std::optional<MotionWeights> lookAt(const std::vector<double>& time, double t) {
  if (time.size() >= 2 && t < time.front()) {
    return MotionWeights{0, 1, 0, t - time.front(), 0, 0, 0, 1, 0};
  }
  return weightsAt(time, t);
}

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
  const Coordinate& observed = encompassing_.coordinate();
  double lastStart = -HUGE_VAL, firstEnd = HUGE_VAL;
  for (const Trial& trial : trials) {
    lastStart = std::max(lastStart, trial.times[0]);
    firstEnd = std::min(firstEnd, trial.times[trial.times.size() - 1]);
  }
  encompassing_.trialsLast(lastStart, firstEnd);
  encompassing_.forget(unsaturated(encompassing_, withFlatTops(trials)));
  quantities_ = encompassing_.quantities();
  for (Trial& trial : trials) {
    OfTrial one{withProxies(std::move(trial), encompassing_), {}, {}, {}, {}, {}, {}, {}, 0, 0};
    for (const MeasuredMotion& motion : one.trial.measured) {
      if (motion.coordinate != coordinate) continue;
      if (options_.usableSeries) requireUsable(one.trial.file, motion);
      one.times.assign(motion.times.begin(), motion.times.end());
      one.measured = motion.values;
    }
    if (one.times.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: no measured value of '{}'", one.trial.file, coordinate));
    }
    one.excitation = excitationOf(one.trial, encompassing_.arm());
    one.external = externalForceOf(one.trial, encompassing_.arm());
    one.known = experimentalConditionsOf(one.trial, encompassing_);
    const double first = one.trial.times[0], last = one.times.back();
    const double intervals =
        std::max(1.0, std::ceil((last - first) / options_.latentSpacing - 1e-9));
    for (int k = 0; k <= static_cast<int>(intervals); ++k) {
      one.nodes.push_back(first + k * options_.latentSpacing);
    }
    one.heldMass = weightOfHeldMass(encompassing_, one.times, one.measured, one.nodes);
    const int index = static_cast<int>(trials_.size());
    const double start = one.measured[0];
    const auto own = [&](const char* what, const char* unit, double nominal, double lower,
                         double upper, double sd) {
      Quantity quantity{fmt::format("trial{}.initial.{}{}", index + 1, coordinate, what),
                        unit,
                        nominal,
                        std::min(lower, nominal),
                        std::max(upper, nominal),
                        sd,
                        false};
      quantity.trial = index;
      nuisances_.push_back(quantities_.size());
      quantities_.push_back(std::move(quantity));
      return quantities_.size() - 1;
    };
    const bool turns = observed.isRotation;
    one.angle =
        own("", turns ? "rad" : "m", start, observed.rangeMin, observed.rangeMax, options_.startSd);
    one.speed =
        own(".speed", turns ? "rad/s" : "m/s", 0, turns ? -10.0 : -2.0, turns ? 10.0 : 2.0,
            std::max(options_.speedSd, std::abs(initialSpeedShown(one.times, one.measured))));
    trials_.push_back(std::move(one));
  }
  latentLag_ = activationLag();
  // the arm answers a push at once, but late muscles late; a clock that is off shifts both
  const bool isPushed = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& one) {
    return std::any_of(one.trial.applied.begin(), one.trial.applied.end(), [&](const auto& push) {
      return push.coordinate == coordinate && push.values.maxCoeff() > push.values.minCoeff();
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

MusculoskeletalProblem::Prediction MusculoskeletalProblem::predictWith(
    const Nudge* nudge, int trial, const VectorXd& values, const VectorXd& latent,
    const std::vector<std::size_t>& wanted, bool latentToo) const {
  const OfTrial& one = of(trial);
  const auto K = static_cast<Index>(one.times.size());
  const auto numNodes = static_cast<Index>(latentToo ? one.nodes.size() : 0);
  Prediction result{
      VectorXd::Constant(K, nan), MatrixXd::Constant(K, static_cast<Index>(wanted.size()), nan),
      MatrixXd::Constant(latentToo ? K : 0, numNodes, nan),
      MatrixXd::Constant(numNodes, 1, options_.latentFloor), VectorXd::Constant(K, nan)};
  ParameterCatalogue::Setting setting = settingAt(one, values, wanted);
  const SensorLaw sensor = encompassing_.sensorAt(values);
  const auto own = encompassing_.quantities().size();
  const double begin = one.trial.times[0];
  const VectorXd modelValues = values.head(static_cast<Index>(own)) + one.known;
  const auto kindOf = [&](std::size_t quantity) {
    return quantity < own ? std::optional(encompassing_.kindOf(quantity)) : std::nullopt;
  };

  // forces that change in time follow those at the nodes
  const MatrixXd timedNodes = timedDirections(one, values, wanted);
  const bool timed = timedNodes.size() > 0;

  // columns of the simulation: the clock, and starts of other trials, have none
  std::vector<ParameterDirection> directions;
  std::vector<Index> column(wanted.size(), -1);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    ParameterDirection direction;
    const int c = encompassing_.freeIndex();
    if (wanted[j] < own) direction = encompassing_.direction(modelValues, wanted[j]);
    const auto kind = kindOf(wanted[j]);
    if (wanted[j] == one.angle || kind == Meaning::Kind::bias || kind == Meaning::Kind::gain)
      direction = {{InitialTarget{c, false}}};
    if (wanted[j] == one.speed) direction = {{InitialTarget{c, true}}};
    if (direction.empty()) continue;
    column[j] = static_cast<Index>(directions.size());
    directions.push_back(std::move(direction));
  }

  SensitivityOptions options;
  SensitivityTrajectory s;
  try {
    options.simulation = simulationOf(one, withTimedForces(one, values, latent), sensor);
    if (nudge) apply(*nudge, setting.model, options.simulation.externalForce);
    if (latentToo || timed) options.externalNodes = {encompassing_.freeIndex(), one.nodes};
    const MusculoskeletalSystem arm = encompassing_.armOf(setting);
    s = simulateWithSensitivities(arm, setting, directions, excitationFor(one, arm), options);
    if (latentToo) {
      Trajectory atNodes;  // the nearest rows
      const auto rows = static_cast<Index>(s.motion.time.size());
      atNodes.q.resize(s.motion.q.rows(), numNodes);
      atNodes.fibreLength.resize(s.motion.fibreLength.rows(), numNodes);
      for (Index k = 0; k < numNodes; ++k) {
        const double at = one.nodes[static_cast<std::size_t>(k)] - s.motion.time.front();
        const Index row = std::clamp<Index>(
            static_cast<Index>(std::lround(at / options.simulation.step)), 0, rows - 1);
        atNodes.q.col(k) = s.motion.q.col(row);
        atNodes.fibreLength.col(k) = s.motion.fibreLength.col(row);
      }
      const MuscleReport muscles = reportMuscles(arm, atNodes, encompassing_.freeIndex());
      result.latentScale.resize(numNodes, muscles.momentArm.rows() + 1);
      result.latentScale << muscles.momentArm.cwiseProduct(muscles.tendonForce).transpose(),
          VectorXd::Constant(numNodes, options_.latentFloor);
    }
  } catch (const std::exception&) {
    return result;  // outside the model's domain
  }

  const auto c = static_cast<std::size_t>(encompassing_.freeIndex());
  const Lagged course = lagged(s.motion.time, s.motion.q.row(encompassing_.freeIndex()),
                               s.motion.qDot.row(encompassing_.freeIndex()), sensor.lag);
  const auto q = course.value.row(0), qDot = course.speed.row(0);
  if (sensor.lag > 0) {
    const auto behind = [&](SensitivityMatrix& of, SensitivityMatrix& rate) {
      const Lagged late = lagged(s.motion.time, of.transpose(), rate.transpose(), sensor.lag);
      of = late.value.transpose();
      rate = late.speed.transpose();
    };
    behind(s.q[c], s.qDot[c]);
    if (numNodes > 0 || timed) behind(s.qOfNodes[c], s.qDotOfNodes[c]);
  }
  const double factor = 1 + sensor.gain;
  const double firstAngle = setting.start.q[encompassing_.freeIndex()];
  for (Index i = 0; i < K; ++i) {
    const double t = one.times[static_cast<std::size_t>(i)];
    const auto w = lookAt(s.motion.time, sensor.measuredAt(t, begin));
    if (!w) continue;
    const double value = w->value(q, qDot), slope = w->slope(q, qDot);
    result.outputs[i] = factor * value + sensor.bias + sensor.drift * (t - begin);
    result.speeds[i] = factor * slope;
    const Eigen::RowVectorXd along = factor * w->rows(s.q[c], s.qDot[c]);
    for (std::size_t j = 0; j < wanted.size(); ++j) {
      double& entry = result.gamma(i, static_cast<Index>(j));
      entry = column[j] >= 0 ? along[column[j]] : 0;
      // what the sensor shows of the first angle stays where it is
      const auto kind = kindOf(wanted[j]);
      if (wanted[j] == one.angle) entry /= factor;
      if (kind == Meaning::Kind::bias) entry = 1 - entry / factor;
      if (kind == Meaning::Kind::gain) entry = value - entry * firstAngle / factor;
      if (kind == Meaning::Kind::clock) entry = -factor * slope;
      if (kind == Meaning::Kind::rate) entry = factor * slope * (t - begin);
      if (kind == Meaning::Kind::lag) {
        entry = factor * w->value(course.inLag.row(0), course.inLagSpeed.row(0));
      }
      if (kind == Meaning::Kind::drift) entry = t - begin;
      if (kind == Meaning::Kind::timed) {
        entry = factor *
                w->rows(s.qOfNodes[c], s.qDotOfNodes[c]).dot(timedNodes.col(static_cast<Index>(j)));
      }
    }
    if (numNodes > 0) {
      result.latentGamma.row(i) = factor * w->rows(s.qOfNodes[c], s.qDotOfNodes[c]);
    }
  }
  return result;
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
