// Simulations of the trials of a MusculoskeletalProblem.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "bio/analysis/inverse_dynamics.h"
#include "bio/analysis/replay.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "discovery/sensed_motion.h"

namespace bio::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd MusculoskeletalProblem::timedForce(int trial, const VectorXd& values) const {
  return withTimedForces(of(trial), values, {});
}

VectorXd MusculoskeletalProblem::withTimedForces(const OfTrial& trial, const VectorXd& values,
                                                 const VectorXd& latent) const {
  VectorXd sum = latent;
  for (const TimedForce& force : encompassing_.timedForces()) {
    const double size = values[static_cast<Index>(force.amplitude)];
    if (size == 0) continue;
    if (sum.size() == 0) sum = VectorXd::Zero(static_cast<Index>(trial.nodes.size()));
    const auto numTimes = static_cast<Index>(trial.nodeTimes.size());
    const Index first = static_cast<Index>(force.coordinate) * numTimes;
    for (Index k = 0; k < numTimes; ++k) {
      const double share = timedShare(trial.nodeTimes[static_cast<std::size_t>(k)],
                                      values[static_cast<Index>(force.time)], force.ends)
                               .value;
      sum[first + k] +=
          size * share * (force.kind == TimedForce::Kind::mass ? trial.heldMass[k] : 1.0);
    }
  }
  return sum;
}

MatrixXd MusculoskeletalProblem::timedDirections(const OfTrial& trial, const VectorXd& values,
                                                 const std::vector<std::size_t>& wanted) const {
  MatrixXd nodes;
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    for (const TimedForce& force : encompassing_.timedForces()) {
      if (wanted[j] != force.amplitude && wanted[j] != force.time) continue;
      const auto rows = static_cast<Index>(trial.nodes.size());
      if (nodes.size() == 0) nodes = MatrixXd::Zero(rows, static_cast<Index>(wanted.size()));
      const double size = values[static_cast<Index>(force.amplitude)];
      const auto numTimes = static_cast<Index>(trial.nodeTimes.size());
      const Index first = static_cast<Index>(force.coordinate) * numTimes;
      for (Index k = 0; k < numTimes; ++k) {
        const TimedShare share = timedShare(trial.nodeTimes[static_cast<std::size_t>(k)],
                                            values[static_cast<Index>(force.time)], force.ends);
        const double weight = force.kind == TimedForce::Kind::mass ? trial.heldMass[k] : 1.0;
        nodes(first + k, static_cast<Index>(j)) =
            weight * (wanted[j] == force.amplitude ? share.value : size * share.inTime);
      }
    }
  }
  return nodes;
}

namespace {

/// A trial without what was measured: copied for every simulation.
Trial inputsOf(const Trial& trial) {
  Trial inputs;
  inputs.file = trial.file;
  inputs.times = trial.times;
  inputs.excitations.resize(trial.times.size(), 0);
  inputs.applied = trial.applied;
  return inputs;
}

/// What a force of 1 in the trial is with the optimal force that a system's actuator has.
double actuatorGain(const AppliedForce& applied, const MusculoskeletalSystem& system) {
  if (applied.actuator.empty() || applied.optimalForce == 0) return 1;
  for (const CoordinateActuator& actuator : system.actuators())
    if (actuator.name == applied.actuator) return actuator.optimalForce / applied.optimalForce;
  return 1;
}

/// ∂τ′ in a quantity of the drive where each interval of the course begins and ends.
std::pair<VectorXd, VectorXd> slopesIn(const DrivenCourse& course, const Drive& drive,
                                       std::size_t quantity) {
  if (quantity == drive.delay) return {course.inDelay, course.inDelay};
  const VectorXd& corners = quantity == drive.gain    ? course.inGain
                            : quantity == drive.lag   ? course.inLag
                            : quantity == drive.share ? course.inShare
                                                      : course.inLimit;
  return {corners.head(corners.size() - 1), corners.tail(corners.size() - 1)};
}

}  // namespace

std::vector<ExternalSlope> MusculoskeletalProblem::driveSlopes(
    const OfTrial& trial, const VectorXd& values, const std::vector<std::size_t>& wanted,
    const std::vector<Index>& places, const MusculoskeletalSystem& system) const {
  std::vector<ExternalSlope> slopes;
  for (const Drive& drive : encompassing_.drives()) {
    const auto isIn = [&](std::size_t quantity) { return drive.owns(quantity); };
    if (std::none_of(wanted.begin(), wanted.end(), isIn)) continue;
    const int coordinate = encompassing_.system().skeleton().indexOf(drive.command.coordinate);
    for (const AppliedForce& applied : trial.trial.applied) {
      if (applied.coordinate != drive.command.coordinate) continue;
      const double gain = actuatorGain(applied, system);
      const DrivenCourse course =
          drivenCourse(trial.trial.times, applied.values, driveLaw(drive, values));
      for (std::size_t j = 0; j < wanted.size(); ++j) {
        if (!isIn(wanted[j])) continue;
        const auto [first, last] = slopesIn(course, drive, wanted[j]);
        slopes.push_back({places[j], coordinate, course.times, gain * first, gain * last});
      }
    }
  }
  return slopes;
}

ParameterCatalogue::Setting MusculoskeletalProblem::settingAt(
    const OfTrial& trial, const VectorXd& values, const std::vector<std::size_t>& wanted) const {
  if (values.size() != static_cast<Index>(quantities_.size())) {
    throw std::invalid_argument(fmt::format("{} values for {} quantities, must be as many",
                                            values.size(), quantities_.size()));
  }
  const auto own = static_cast<Index>(encompassing_.quantities().size());
  ParameterCatalogue::Setting setting =
      encompassing_.settingAt(values.head(own) + trial.conditions, wanted);
  for (const Start& start : trial.starts) {
    const int c = encompassing_.coordinates()[start.coordinate].index;
    SensorLaw sensor;
    if (start.sensor >= 0)
      sensor = encompassing_.sensorAt(values, static_cast<std::size_t>(start.sensor));
    setting.start.q[c] =
        (values[static_cast<Index>(start.angle)] - sensor.bias) / (1 + sensor.gain);
    setting.start.qDot[c] = values[static_cast<Index>(start.speed)];
  }
  if (!encompassing_.system().prescribed().empty())
    trial.recorded.simulation.prescribed.place(trial.trial.times[0], setting.start.q,
                                               setting.start.qDot);
  return setting;
}

SimulationOptions MusculoskeletalProblem::simulationOf(const OfTrial& trial, const VectorXd& values,
                                                       const VectorXd& latent) const {
  SimulationOptions simulation = trial.recorded.simulation;
  if (const DriveLaws laws = encompassing_.driveLawsAt(values); !laws.empty())
    simulation.externalForce =
        externalForceOf(withDrives(inputsOf(trial.trial), laws), encompassing_.system());
  // a sensor may look behind the last sample
  double end = trial.times.back();
  for (const Series& series : trial.series) {
    const SensorLaw sensor = encompassing_.sensorAt(values, series.sensor);
    end = std::max(end, sensor.measuredAt(series.times.back(), simulation.startTime));
  }
  if (!encompassing_.system().prescribed().empty())
    end = std::min(end, trial.trial.times[trial.trial.times.size() - 1]);  // beyond, none is given
  simulation.duration = end - simulation.startTime;
  if (latent.size() == 0) return simulation;
  if (latent.size() != static_cast<Index>(trial.nodes.size())) {
    throw std::invalid_argument(
        fmt::format("{} values of the latent force for {} nodes, must be as many", latent.size(),
                    trial.nodes.size()));
  }
  const auto numTimes = static_cast<Index>(trial.nodeTimes.size());
  MatrixXd forces = MatrixXd::Zero(numTimes, encompassing_.system().skeleton().numCoordinates());
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    forces.col(encompassing_.coordinates()[axis].index) =
        latent.segment(static_cast<Index>(axis) * numTimes, numTimes);
  simulation.externalForce = sum(simulation.externalForce, {trial.nodeTimes, forces});
  return simulation;
}

// The system may have muscles that the base model switched off.
ExcitationSignal MusculoskeletalProblem::excitationFor(const OfTrial& trial,
                                                       const MusculoskeletalSystem& system) const {
  return system.numMuscles() == encompassing_.system().numMuscles()
             ? trial.recorded.excitation
             : excitationOf(trial.trial, system);
}

MusculoskeletalProblem::Simulated MusculoskeletalProblem::simulate(
    const OfTrial& trial, const VectorXd& values, const VectorXd& latent, double stepFactor,
    const std::vector<Nudge>* nudges) const {
  ParameterCatalogue::Setting setting = settingAt(trial, values, {});
  SimulationOptions simulation =
      simulationOf(trial, values, withTimedForces(trial, values, latent));
  if (nudges) {
    for (const Nudge& nudge : *nudges) apply(nudge, setting.model, simulation.externalForce);
  }
  simulation.step *= stepFactor;
  MusculoskeletalSystem system = encompassing_.systemOf(setting);
  Trajectory motion = simulateSetting(system, setting, excitationFor(trial, system), simulation);
  return {std::move(system), std::move(motion)};
}

VectorXd MusculoskeletalProblem::outputsOf(const OfTrial& trial, const VectorXd& values,
                                           const VectorXd& latent, double stepFactor,
                                           const std::vector<Nudge>* nudges) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  VectorXd y = VectorXd::Constant(static_cast<Index>(trial.times.size()), nan);
  try {
    const auto [system, motion] = simulate(trial, values, latent, stepFactor, nudges);
    const std::vector<SensedMotion> sensors = sensedBy(system, trial, values);
    for (std::size_t i = 0; i < sensors.size(); ++i)
      y(trial.series[i].samples) = sensors[i].shown(motion).values;
  } catch (const std::exception&) {
    y.setConstant(nan);  // outside its domain
  }
  return y;
}

std::vector<SensedMotion> MusculoskeletalProblem::sensedBy(const MusculoskeletalSystem& system,
                                                           const OfTrial& trial,
                                                           const VectorXd& values) const {
  std::vector<SensedMotion> sensors;
  for (const Series& series : trial.series) {
    sensors.emplace_back(system, encompassing_.sensors()[series.sensor],
                         encompassing_.sensorAt(values, series.sensor), series.times,
                         trial.trial.times[0]);
  }
  return sensors;
}

VectorXd MusculoskeletalProblem::outputs(int trial, const VectorXd& values,
                                         const VectorXd& latent) const {
  return outputsOf(of(trial), values, latent, 1, nullptr);
}

VectorXd MusculoskeletalProblem::refinedOutputs(int trial, const VectorXd& values) const {
  return outputsOf(of(trial), values, {}, 0.5, nullptr);
}

Trajectory MusculoskeletalProblem::motion(int trial, const VectorXd& values) const {
  return simulate(of(trial), values, {}, 1, nullptr).motion;
}

Trajectory MusculoskeletalProblem::inverseDynamics(int trial, const VectorXd& values,
                                                   const Trajectory& motion) const {
  const OfTrial& one = of(trial);
  const ParameterCatalogue::Setting setting = settingAt(one, values, {});
  MusculoskeletalSystem system = encompassing_.systemOf(setting);
  const ExcitationSignal driven =
      drivenExcitation(excitationFor(one, system), muscleNames(system), setting.mapping);
  return bio::inverseDynamics(std::move(system), driven, motion.time, motion.q,
                              simulationOf(one, values, withTimedForces(one, values, {})));
}

MusculoskeletalSystem MusculoskeletalProblem::systemAt(int trial, const VectorXd& values) const {
  return encompassing_.systemOf(settingAt(of(trial), values, {}));
}

std::vector<TrialStart> MusculoskeletalProblem::startsAt(int trial, const VectorXd& values) const {
  const OfTrial& one = of(trial);
  const StartPoint point = settingAt(one, values, {}).start;
  std::vector<TrialStart> starts;
  for (const Start& start : one.starts) {
    const MovingCoordinate& at = encompassing_.coordinates()[start.coordinate];
    starts.push_back({one.trial.file, one.trial.sha256, at.coordinate.name, point.q[at.index],
                      point.qDot[at.index]});
  }
  return starts;
}

std::string MusculoskeletalProblem::failure(int trial, const VectorXd& values) const {
  try {
    return simulate(of(trial), values, {}, 1, nullptr).motion.why;
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace bio::discover
