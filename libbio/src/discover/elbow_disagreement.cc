#include "bio/discover/elbow_disagreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "bio/coupled_sensitivity.h"
#include "bio/discover/effects.h"
#include "bio/replay.h"
#include "bio/trial_review.h"
#include "motion_weights.h"

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

/// The torque of the trial and the latent one, straight between the nodes of both.
ExternalForce together(const ExternalForce& external, const std::vector<double>& nodes,
                       const VectorXd& latent, int freeIndex, Index coordinates) {
  MatrixXd values = MatrixXd::Zero(latent.size(), coordinates);
  values.col(freeIndex) = latent;
  ExternalForce force(nodes, values);
  if (external.empty()) return force;
  std::set<double> rows(nodes.begin(), nodes.end());
  rows.insert(external.times().begin(), external.times().end());
  const std::vector<double> times(rows.begin(), rows.end());
  MatrixXd sum(static_cast<Index>(times.size()), coordinates);
  for (std::size_t k = 0; k < times.size(); ++k) {
    sum.row(static_cast<Index>(k)) =
        (external.at(times[k]).value + force.at(times[k]).value).transpose();
  }
  return {times, sum};
}

/// There will be thousands of simulations.
ArmOptions withTables(ArmOptions arm) {
  arm.tabulatePaths = true;
  return arm;
}

}  // namespace

ElbowDisagreement::ElbowDisagreement(const Model& model, const ArmOptions& arm,
                                     const std::string& coordinate, std::vector<Trial> trials,
                                     ElbowOptions options)
    : widest_(widestModel(model, withTables(arm), coordinate, options.without, options.formula)),
      options_(std::move(options)),
      quantities_(widest_.quantities()),
      nuisances_(widest_.nuisances()) {
  if (trials.empty()) throw std::invalid_argument("no trial is given");
  const auto positive = [](double value, const char* what) {
    if (!(value > 0 && std::isfinite(value))) {
      throw std::invalid_argument(fmt::format("{} = {}, must be > 0", what, value));
    }
  };
  positive(options_.latentSpacing, "spacing of the latent force");
  positive(options_.latentFloor, "floor of the latent force's scale");
  positive(options_.startDeviation, "deviation of the start");
  positive(options_.speedDeviation, "deviation of the start's speed");
  const Integrator integrator = options_.simulation.integrator;
  if (integrator != Integrator::variational && integrator != Integrator::variationalLeft) {
    throw std::invalid_argument("sensitivities: the integrator must be vi or vi-left");
  }
  const Coordinate& observed = widest_.coordinate();
  for (Trial& trial : trials) {
    OfTrial one{withProxies(std::move(trial), widest_), {}, {}, {}, {}, {}, {}, 0, 0};
    for (const MeasuredMotion& motion : one.trial.measured) {
      if (motion.coordinate != coordinate) continue;
      requireUsable(one.trial.file, motion);
      one.times.assign(motion.times.begin(), motion.times.end());
      one.measured = motion.values;
    }
    if (one.times.empty()) {
      throw std::invalid_argument(
          fmt::format("{}: no measured value of '{}'", one.trial.file, coordinate));
    }
    one.excitation = excitationOf(one.trial, widest_.arm());
    one.external = externalForceOf(one.trial, widest_.arm());
    one.known = knownChanges(one.trial);
    const double first = one.trial.times[0], last = one.times.back();
    const double intervals =
        std::max(1.0, std::ceil((last - first) / options_.latentSpacing - 1e-9));
    for (int k = 0; k <= static_cast<int>(intervals); ++k) {
      one.nodes.push_back(first + k * options_.latentSpacing);
    }
    const int index = static_cast<int>(trials_.size());
    const double start = one.measured[0];
    const auto own = [&](const char* what, const char* unit, double nominal, double lower,
                         double upper, double deviation) {
      Quantity quantity{fmt::format("trial{}.initial.{}{}", index + 1, coordinate, what),
                        unit,
                        nominal,
                        std::min(lower, nominal),
                        std::max(upper, nominal),
                        deviation,
                        false};
      quantity.trial = index;
      nuisances_.push_back(quantities_.size());
      quantities_.push_back(std::move(quantity));
      return quantities_.size() - 1;
    };
    const bool turns = observed.isRotation;
    one.angle = own("", turns ? "rad" : "m", start, observed.rangeMin, observed.rangeMax,
                    options_.startDeviation);
    one.speed = own(".speed", turns ? "rad/s" : "m/s", 0, turns ? -10.0 : -2.0, turns ? 10.0 : 2.0,
                    options_.speedDeviation);
    trials_.push_back(std::move(one));
  }
  latentLag_ = activationLag();
  // the arm answers a push at once, but late muscles late; a clock that is off shifts both
  const bool isPushed = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& one) {
    return std::any_of(one.trial.applied.begin(), one.trial.applied.end(), [&](const auto& push) {
      return push.coordinate == coordinate && push.values.maxCoeff() > push.values.minCoeff();
    });
  });
  if (isPushed) widest_.separate("delay", "clock");
  // gravity's moment grows with a mass, that of a force on the hand does not
  const bool isLoaded = std::any_of(trials_.begin(), trials_.end(), [&](const OfTrial& one) {
    return one.trial.known.massInHand != trials_.front().trial.known.massInHand;
  });
  if (isLoaded) widest_.separate("tilt", "handforce");
}

VectorXd ElbowDisagreement::knownChanges(const Trial& trial) const {
  VectorXd changes = VectorXd::Zero(static_cast<Index>(widest_.quantities().size()));
  if (!trial.known.any()) return changes;
  const auto change = [&](const std::string& name, double value, const char* why) {
    if (value == 0) return;
    const auto& quantities = widest_.quantities();
    const auto at = std::find_if(quantities.begin(), quantities.end(),
                                 [&](const auto& one) { return one.name == name; });
    if (at == quantities.end()) {
      throw std::invalid_argument(
          fmt::format("{}: recorded {}, but {}", trial.file, inWords(trial.known), why));
    }
    changes[at - quantities.begin()] = value;
  };
  change("known.mass", trial.known.massInHand, "the model moves no body that could hold it");
  change("known.turn", trial.known.armTurn, "the coordinate does not turn bodies across gravity");
  if (trial.known.armTurn != 0 && widest_.present().count("handforce") > 0) {
    throw std::invalid_argument(
        fmt::format("{}: recorded {}, but the model has a force on the hand ({}) that would turn "
                    "with the arm",
                    trial.file, inWords(trial.known), widest_.present().at("handforce")));
  }
  return changes;
}

double ElbowDisagreement::activationLag() const {
  double sum = 0, count = 0;
  for (const OfTrial& one : trials_) {
    const auto& times = one.excitation.times();
    VectorXd u(one.excitation.numMuscles());
    std::size_t hint = 0;
    for (const double t : times) {
      one.excitation.at(t, hint, u);
      for (Index i = 0; i < u.size(); ++i) {
        const auto& law = widest_.arm().muscles()[static_cast<std::size_t>(i)].activation;
        sum += 2 / (law.rateConstant(u[i], true) + law.rateConstant(u[i], false));
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : 0;
}

ParameterCatalogue::Setting ElbowDisagreement::settingAt(
    const OfTrial& one, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  if (values.size() != static_cast<Index>(quantities_.size())) {
    throw std::invalid_argument(
        fmt::format("{} values for {} quantities", values.size(), quantities_.size()));
  }
  const auto own = static_cast<Index>(widest_.quantities().size());
  ParameterCatalogue::Setting setting = widest_.settingAt(values.head(own) + one.known, wanted);
  const SensorLaw sensor = widest_.sensorAt(values);
  setting.start.q[widest_.freeIndex()] =
      (values[static_cast<Index>(one.angle)] - sensor.bias) / (1 + sensor.gain);
  setting.start.qDot[widest_.freeIndex()] = values[static_cast<Index>(one.speed)];
  return setting;
}

SimulationOptions ElbowDisagreement::simulationOf(const OfTrial& one, const VectorXd& latent,
                                                  double clock) const {
  SimulationOptions simulation = options_.simulation;
  simulation.startTime = one.trial.times[0];
  // a sensor that runs ahead looks behind the last sample
  simulation.duration = one.times.back() - simulation.startTime + std::max(0.0, -clock);
  simulation.progress = {};
  simulation.externalForce = one.external;
  if (latent.size() == 0) return simulation;
  if (latent.size() != static_cast<Index>(one.nodes.size())) {
    throw std::invalid_argument(
        fmt::format("{} values of the latent force for {} nodes", latent.size(), one.nodes.size()));
  }
  simulation.externalForce = together(one.external, one.nodes, latent, widest_.freeIndex(),
                                      widest_.arm().skeleton().numCoordinates());
  return simulation;
}

// The arm may have muscles that the base model switched off.
ExcitationSignal ElbowDisagreement::excitationFor(const OfTrial& one, const Arm& arm) const {
  return arm.numMuscles() == widest_.arm().numMuscles() ? one.excitation
                                                        : excitationOf(one.trial, arm);
}

Trajectory ElbowDisagreement::simulate(const OfTrial& one, const VectorXd& values,
                                       const VectorXd& latent, double stepFactor) const {
  const ParameterCatalogue::Setting setting = settingAt(one, values, {});
  SimulationOptions simulation = simulationOf(one, latent, widest_.sensorAt(values).clock);
  simulation.step *= stepFactor;
  const Arm arm = widest_.armOf(setting);
  return simulateSetting(arm, setting, excitationFor(one, arm), simulation);
}

VectorXd ElbowDisagreement::outputsOf(const OfTrial& one, const VectorXd& values,
                                      const VectorXd& latent, double stepFactor) const {
  VectorXd y = VectorXd::Constant(static_cast<Index>(one.times.size()), nan);
  Trajectory motion;
  try {
    motion = simulate(one, values, latent, stepFactor);
  } catch (const std::exception&) {
    return y;  // outside its domain
  }
  const SensorLaw sensor = widest_.sensorAt(values);
  const int c = widest_.freeIndex();
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    const auto w = lookAt(motion.time, one.times[i] - sensor.clock);
    if (!w) continue;
    y[static_cast<Index>(i)] =
        (1 + sensor.gain) * w->value(motion.q.row(c), motion.qDot.row(c)) + sensor.bias;
  }
  return y;
}

VectorXd ElbowDisagreement::outputs(int trial, const VectorXd& values,
                                    const VectorXd& latent) const {
  return outputsOf(of(trial), values, latent, 1);
}

VectorXd ElbowDisagreement::refinedOutputs(int trial, const VectorXd& values) const {
  return outputsOf(of(trial), values, {}, 0.5);
}

std::string ElbowDisagreement::failure(int trial, const VectorXd& values) const {
  try {
    return simulate(of(trial), values, {}, 1).why;
  } catch (const std::exception& error) {
    return error.what();
  }
}

ElbowDisagreement::Prediction ElbowDisagreement::predict(int trial, const VectorXd& values,
                                                         const VectorXd& latent,
                                                         const std::vector<std::size_t>& wanted,
                                                         bool latentToo) const {
  const OfTrial& one = of(trial);
  const auto K = static_cast<Index>(one.times.size());
  const auto numNodes = static_cast<Index>(latentToo ? one.nodes.size() : 0);
  Prediction result{
      VectorXd::Constant(K, nan), MatrixXd::Constant(K, static_cast<Index>(wanted.size()), nan),
      MatrixXd::Constant(latentToo ? K : 0, numNodes, nan),
      MatrixXd::Constant(numNodes, 1, options_.latentFloor), VectorXd::Constant(K, nan)};
  const ParameterCatalogue::Setting setting = settingAt(one, values, wanted);
  const SensorLaw sensor = widest_.sensorAt(values);
  const auto own = widest_.quantities().size();
  const VectorXd modelValues = values.head(static_cast<Index>(own)) + one.known;
  const auto kindOf = [&](std::size_t quantity) {
    return quantity < own ? std::optional(widest_.kindOf(quantity)) : std::nullopt;
  };

  // columns of the simulation: the clock, and starts of other trials, have none
  std::vector<ParameterDirection> directions;
  std::vector<Index> column(wanted.size(), -1);
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    ParameterDirection direction;
    const int c = widest_.freeIndex();
    if (wanted[j] < own) direction = widest_.direction(modelValues, wanted[j]);
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
    options.simulation = simulationOf(one, latent, sensor.clock);
    if (latentToo) options.externalNodes = {widest_.freeIndex(), one.nodes};
    const Arm arm = widest_.armOf(setting);
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
      const MuscleReport muscles = reportMuscles(arm, atNodes, widest_.freeIndex());
      result.latentScale.resize(numNodes, muscles.momentArm.rows() + 1);
      result.latentScale << muscles.momentArm.cwiseProduct(muscles.tendonForce).transpose(),
          VectorXd::Constant(numNodes, options_.latentFloor);
    }
  } catch (const std::exception&) {
    return result;  // outside the model's domain
  }

  const auto c = static_cast<std::size_t>(widest_.freeIndex());
  const auto q = s.motion.q.row(widest_.freeIndex());
  const auto qDot = s.motion.qDot.row(widest_.freeIndex());
  const double factor = 1 + sensor.gain;
  const double firstAngle = setting.start.q[widest_.freeIndex()];
  for (Index i = 0; i < K; ++i) {
    const auto w = lookAt(s.motion.time, one.times[static_cast<std::size_t>(i)] - sensor.clock);
    if (!w) continue;
    const double value = w->value(q, qDot), slope = w->slope(q, qDot);
    result.outputs[i] = factor * value + sensor.bias;
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
    }
    if (numNodes > 0) {
      result.latentGamma.row(i) = factor * w->rows(s.qOfNodes[c], s.qDotOfNodes[c]);
    }
  }
  return result;
}

MatrixXd ElbowDisagreement::inputs(int trial) const {
  const OfTrial& one = of(trial);
  MatrixXd values(static_cast<Index>(one.times.size()), one.excitation.numMuscles());
  std::size_t hint = 0;
  for (std::size_t i = 0; i < one.times.size(); ++i) {
    one.excitation.at(one.times[i], hint, values.row(static_cast<Index>(i)).transpose());
  }
  return values;
}

std::vector<std::string> ElbowDisagreement::inputNames() const {
  return muscleNames(widest_.arm());
}

std::unique_ptr<info::discover::Disagreement> ElbowDisagreement::withFormula(
    const std::vector<info::discover::FormulaTerm>& terms,
    const std::vector<std::size_t>& kept) const {
  ElbowOptions options = options_;
  options.formula = terms;
  for (std::size_t c = 0; c < candidates().size(); ++c) {
    if (std::find(kept.begin(), kept.end(), c) == kept.end())
      options.without.push_back(candidates()[c].id);
  }
  std::vector<Trial> trials;
  for (const OfTrial& one : trials_) trials.push_back(one.trial);
  auto widened = std::make_unique<ElbowDisagreement>(widest_.base(), widest_.armOptions(),
                                                     widest_.coordinate().name, std::move(trials),
                                                     std::move(options));
  if (!widened->widest().knows("formula")) return nullptr;
  return widened;
}

}  // namespace bio::discover
