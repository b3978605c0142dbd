#include "bio/analysis/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "analysis/initial_speed.h"
#include "bio/model/units.h"
#include "bio/observation/observed_motion.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/simulation/integrator_names.h"
#include "simulation/integrators.h"
#include "simulation/motion_weights.h"

namespace bio {

ExcitationSignal excitationOf(const Trial& trial, const MusculoskeletalSystem& system) {
  const auto n = static_cast<Eigen::Index>(system.numMuscles());
  Eigen::MatrixXd values(trial.times.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& name = system.muscles()[static_cast<std::size_t>(i)].name;
    const auto at = std::find(trial.muscles.begin(), trial.muscles.end(), name);
    if (at == trial.muscles.end()) {
      throw std::invalid_argument(
          fmt::format("{}: no excitation of muscle '{}'", trial.file, name));
    }
    values.col(i) = trial.excitations.col(at - trial.muscles.begin());
  }
  return {std::vector<double>(trial.times.begin(), trial.times.end()), values};
}

ExternalForce externalForceOf(const Trial& trial, const MusculoskeletalSystem& system) {
  if (trial.applied.empty()) return {};
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(trial.times.size(), system.skeleton().numCoordinates());
  const std::vector<double> times(trial.times.begin(), trial.times.end());
  std::vector<ExternalForce::Control> controls;
  for (const AppliedForce& applied : trial.applied) {
    const int index = system.skeleton().indexOf(applied.coordinate);
    if (index < 0 && !applied.actuator.empty()) continue;  // on a coordinate that is held
    if (index < 0) {
      throw std::invalid_argument(
          fmt::format("{}: a torque or force acts on '{}', which is not free to move", trial.file,
                      applied.coordinate));
    }
    values.col(index) += applied.values;
    if (applied.actuator.empty()) continue;
    controls.push_back({applied.actuator, index, applied.optimalForce, times, applied.control});
  }
  return {times, std::move(values), std::move(controls)};
}

RecordedTrial recordedTrial(const Trial& trial, const MusculoskeletalSystem& system,
                            SimulationOptions options) {
  options.startTime = trial.times[0];
  options.duration = trial.duration();
  options.externalForce = externalForceOf(trial, system);
  options.prescribed = prescribedMotionOf(trial, system);
  return {excitationOf(trial, system), std::move(options)};
}

SystemState RecordedTrial::startAt(const MusculoskeletalSystem& system,
                                   const StartPoint& point) const {
  SystemState state = initialState(system, point.q, excitation, simulation.startTime);
  state.qDot = point.qDot;
  return state;
}

Eigen::VectorXd startCoordinates(const Trial& trial, const MusculoskeletalSystem& system,
                                 const std::map<std::string, double>& given) {
  const auto& free = system.skeleton().coordinates();
  for (const auto& [name, value] : given) {
    const int index = system.skeleton().indexOf(name);
    if (index >= 0 && system.isPrescribed(index)) {
      throw std::invalid_argument(
          fmt::format("start of '{}': its motion is prescribed, must not be given", name));
    }
    if (index < 0) {
      std::string known;
      for (const Coordinate& c : free) known += (known.empty() ? "" : ", ") + c.name;
      throw std::invalid_argument(
          fmt::format("start of '{}': must be a free coordinate (free: {})", name, known));
    }
    if (!std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("start of '{}' = {}, must be finite", name, value));
    }
  }
  Eigen::VectorXd q(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    double value = free[i].defaultValue;
    const MeasuredChannel* measured = trial.measurementOf(ofCoordinate(free[i].name));
    if (measured && measured->values.size() > 0) value = measured->values[0];
    const auto at = given.find(free[i].name);
    q[static_cast<Eigen::Index>(i)] = at != given.end() ? at->second : value;
  }
  if (!system.prescribed().empty()) prescribedMotionOf(trial, system).place(trial.times[0], q);
  return q;
}

const char* name(TrialBeginning::From from) {
  static constexpr const char* names[] = {"given", "model", "measured", "default"};
  return names[static_cast<int>(from)];
}

TrialBeginning beginningOf(const Trial& trial, const Model& model,
                           const MusculoskeletalSystem& system,
                           const std::map<std::string, double>& given) {
  using From = TrialBeginning::From;
  TrialBeginning beginning;
  beginning.point.q = startCoordinates(trial, system, given);
  beginning.point.qDot = beginning.point.speedSd = Eigen::VectorXd::Zero(beginning.point.q.size());
  if (!system.prescribed().empty()) {
    Eigen::VectorXd q = beginning.point.q;
    prescribedMotionOf(trial, system).place(trial.times[0], q, beginning.point.qDot);
  }
  bool isMeasured = false, isFitted = false;
  for (Eigen::Index i = 0; i < beginning.point.q.size(); ++i) {
    const std::string& free = system.skeleton().coordinates()[static_cast<std::size_t>(i)].name;
    if (given.contains(free) || system.isPrescribed(static_cast<int>(i))) continue;
    const MeasuredChannel* measured = trial.measurementOf(ofCoordinate(free));
    if (measured && measured->values.size() > 0) {
      isMeasured = true;
      const bool turns = system.skeleton().coordinates()[static_cast<std::size_t>(i)].isRotation;
      beginning.point.speedSd[i] =
          std::abs(initialSpeedShown({measured->times.begin(), measured->times.end()},
                                     measured->values, turns ? 0.3 : 0.3 / 8));
    }
    for (const TrialStart& start : model.fitted.starts) {
      if (trial.sha256.empty() || start.sha256 != trial.sha256 || start.coordinate != free)
        continue;
      beginning.point.q[i] = start.value;
      beginning.point.qDot[i] = start.speed;
      beginning.point.speedSd[i] = 0;  // the fit knows it better
      isFitted = true;
    }
  }
  beginning.from = isFitted         ? From::model
                   : !given.empty() ? From::given
                   : isMeasured     ? From::measured
                                    : From::defaults;
  return beginning;
}

double stepOf(const Model& model, Integrator integrator, const std::optional<double>& given) {
  if (given) return *given;
  return isVariational(integrator) && model.fitted.step ? *model.fitted.step
                                                        : defaultStep(integrator);
}

std::vector<double> observedTimes(const Trial& trial, const std::string& coordinate, double step) {
  const MeasuredChannel* measured = trial.measurementOf(ofCoordinate(coordinate));
  if (measured && measured->times.size() > 0)
    return {measured->times.begin(), measured->times.end()};
  const double begin = trial.times[0], end = trial.times[trial.times.size() - 1];
  std::vector<double> times;
  for (int k = 0; begin + k * step <= end + 1e-9; ++k) times.push_back(begin + k * step);
  return times;
}

namespace {

/// Where the simulation has a value; rms 0 if it has none.
MeasuredError errorOf(const Eigen::VectorXd& times, const Eigen::VectorXd& simulated,
                      const Eigen::VectorXd& measured) {
  MeasuredError error;
  double sum = 0;
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    const double difference = simulated[i] - measured[i];
    if (std::isnan(difference)) continue;
    sum += difference * difference;
    ++error.count;
    if (std::abs(difference) > error.largest) {
      error.largest = std::abs(difference);
      error.largestAt = times[i];
    }
  }
  if (error.count > 0) error.rms = std::sqrt(sum / static_cast<double>(error.count));
  return error;
}

}  // namespace

MeasuredError compareWithMeasured(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                                  const MeasuredChannel& measured) {
  const int index = system.skeleton().indexOf(measured.what.object);
  if (index < 0) {
    throw std::invalid_argument(
        fmt::format("measured coordinate '{}' is not free", measured.what.object));
  }
  const std::vector<double>& time = trajectory.time;
  Eigen::VectorXd simulated =
      Eigen::VectorXd::Constant(measured.times.size(), std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < measured.times.size(); ++i) {
    const double t = measured.times[i];
    if (t < time.front() - 1e-9 || t > time.back() + 1e-9) continue;
    const auto w = weightsAt(time, t);
    simulated[i] =
        w ? w->value(trajectory.q.row(index), trajectory.qDot.row(index)) : trajectory.q(index, 0);
  }
  const MeasuredError error = errorOf(measured.times, simulated, measured.values);
  if (error.count == 0) {
    throw std::invalid_argument(
        fmt::format("measured coordinate '{}': no value between {} s and {} s",
                    measured.what.object, time.front(), time.back()));
  }
  return error;
}

TrialReplay replayTrial(const MusculoskeletalSystem& system, const Trial& trial,
                        SimulationOptions options, TrialBeginning beginning,
                        const EmgMapping& mapping) {
  TrialReplay replay;
  RecordedTrial recorded = recordedTrial(trial, system, std::move(options));
  recorded.excitation = drivenExcitation(recorded.excitation, muscleNames(system), mapping);
  replay.beginning = std::move(beginning);
  replay.mapping = mapping;
  replay.motion = simulate(system, recorded.excitation,
                           recorded.startAt(system, replay.beginning.point), recorded.simulation);
  for (const MeasuredChannel& measured : trial.measured) {
    if (measured.times.size() == 0 || measured.times[0] > replay.motion.time.back()) continue;
    if (!measured.what.isCoordinate()) {
      const ObservedMotion observed(system, {{measured.what, measured.times}});
      replay.channelErrors.push_back(
          {measured.what,
           errorOf(measured.times, observed.values(replay.motion), measured.values)});
    } else if (system.skeleton().indexOf(measured.what.object) >= 0) {
      replay.errors.emplace_back(measured.what.object,
                                 compareWithMeasured(system, replay.motion, measured));
    }
  }
  recorded.simulation.progress = {};
  replay.options = std::move(recorded.simulation);
  return replay;
}

std::vector<LeftRange> leftRanges(const MusculoskeletalSystem& system,
                                  const Trajectory& trajectory) {
  std::vector<LeftRange> left;
  for (std::size_t i = 0; i < system.skeleton().coordinates().size(); ++i) {
    const Coordinate& c = system.skeleton().coordinates()[i];
    const ShownUnit unit = positionUnit(c.isRotation);
    const double margin = 1 / unit.factor;
    const Eigen::VectorXd q = trajectory.q.row(static_cast<Eigen::Index>(i));
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      if (q[k] >= c.rangeMin - margin && q[k] <= c.rangeMax + margin) continue;
      const double time = trajectory.time[static_cast<std::size_t>(k)];
      left.push_back(
          {time, c.name,
           fmt::format(
               "{0} leaves its range, {1:.4g} to {2:.4g} {3}, at {4:.3g} s and reaches {5:.4g} to "
               "{6:.4g} {3}: the model has no passive force that prevents this",
               c.name, c.rangeMin * unit.factor, c.rangeMax * unit.factor, unit.name, time,
               q.minCoeff() * unit.factor, q.maxCoeff() * unit.factor)});
      break;
    }
  }
  return left;
}

std::optional<LeftRange> leftRange(const MusculoskeletalSystem& system,
                                   const Trajectory& trajectory) {
  std::optional<LeftRange> first;
  const auto look = [&](const std::string& name, const Eigen::VectorXd& values, double low,
                        double high, const std::function<std::string(double)>& sentence) {
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      if (values[k] >= low && values[k] <= high) continue;
      const double time = trajectory.time[static_cast<std::size_t>(k)];
      if (!first || time < first->time) first = LeftRange{time, name, sentence(time)};
      return;
    }
  };
  for (std::size_t i = 0; i < system.skeleton().coordinates().size(); ++i) {
    const Coordinate& c = system.skeleton().coordinates()[i];
    const ShownUnit unit = positionUnit(c.isRotation);
    const double margin = std::max(0.1 * (c.rangeMax - c.rangeMin), 1 / unit.factor);
    const Eigen::VectorXd q = trajectory.q.row(static_cast<Eigen::Index>(i));
    look(c.name, q, c.rangeMin - margin, c.rangeMax + margin, [&](double time) {
      return fmt::format(
          "{0} leaves its range, {1:.4g} to {2:.4g} {3}, by more than a tenth of it "
          "at {4:.3g} s and reaches {5:.4g} to {6:.4g} {3}{7}",
          c.name, c.rangeMin * unit.factor, c.rangeMax * unit.factor, unit.name, time,
          q.minCoeff() * unit.factor, q.maxCoeff() * unit.factor,
          c.isRotation ? ""
                       : " (no force of the model holds it, and contact is not simulated: lock it, "
                         "or prescribe it)");
    });
  }
  for (std::size_t i = 0; i < system.numMuscles(); ++i) {
    const SystemMuscle& muscle = system.muscles()[i];
    const Eigen::VectorXd l =
        trajectory.fibreLength.row(static_cast<Eigen::Index>(i)) * muscle.muscle.perFibre();
    look(muscle.name, l, 0.2, 2, [&](double time) {
      return fmt::format(
          "the fibres of {} leave 0.2 to 2 optimal lengths at {:.3g} s and reach "
          "{:.3g} to {:.3g}",
          muscle.name, time, l.minCoeff(), l.maxCoeff());
    });
  }
  return first;
}

Table statesTable(const Model& model, const MusculoskeletalSystem& system,
                  const Trajectory& trajectory) {
  const Skeleton& skeleton = system.skeleton();
  const auto K = static_cast<Eigen::Index>(trajectory.time.size());
  Table table;
  table.name = "states";
  table.columns = {"time"};
  std::vector<Eigen::VectorXd> columns = {
      Eigen::Map<const Eigen::VectorXd>(trajectory.time.data(), K)};
  const auto add = [&](const std::string& name, Eigen::VectorXd values) {
    table.columns.push_back(name);
    columns.push_back(std::move(values));
  };
  for (const Joint& joint : model.joints) {
    for (const Coordinate& coordinate : joint.coordinates) {
      const std::string within =
          coordinate.name.find('/') == std::string::npos ? joint.name + "/" : "";
      const std::string path = "/jointset/" + within + coordinate.name;
      const Skeleton::CoordinateSource& source = skeleton.sourceOf(coordinate.name);
      Eigen::VectorXd value = Eigen::VectorXd::Constant(K, source.value);
      Eigen::VectorXd speed = Eigen::VectorXd::Zero(K);
      if (source.freeIndex >= 0) {
        for (Eigen::Index k = 0; k < K; ++k) {
          const CurveValue y = source.coupling.evaluate(trajectory.q(source.freeIndex, k));
          value[k] = y.value;
          speed[k] = y.slope * trajectory.qDot(source.freeIndex, k);
        }
      }
      add(path + "/value", value);
      add(path + "/speed", speed);
    }
  }
  for (std::size_t i = 0; i < system.numMuscles(); ++i) {
    const std::string path = "/forceset/" + system.muscles()[i].name;
    const auto row = static_cast<Eigen::Index>(i);
    add(path + "/activation", trajectory.activation.row(row).transpose());
    add(path + "/fiber_length", trajectory.fibreLength.row(row).transpose());
  }
  table.values.resize(K, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    table.values.col(static_cast<Eigen::Index>(c)) = columns[c];
  }
  return table;
}

Table forcesTable(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                  const MuscleReport& report) {
  const auto K = static_cast<Eigen::Index>(trajectory.time.size());
  Table table;
  table.name = "tendon forces [N]";
  table.columns = {"time"};
  for (const SystemMuscle& muscle : system.muscles()) table.columns.push_back(muscle.name);
  const auto prescribed = static_cast<Eigen::Index>(system.prescribed().size());
  const Eigen::Index muscles = report.tendonForce.rows();
  table.values.resize(K, 1 + muscles + prescribed);
  table.values.col(0) = Eigen::Map<const Eigen::VectorXd>(trajectory.time.data(), K);
  table.values.middleCols(1, muscles) = report.tendonForce.transpose();
  for (Eigen::Index i = 0; i < prescribed; ++i) {
    const int k = system.prescribed()[static_cast<std::size_t>(i)];
    table.columns.push_back(system.skeleton().coordinates()[static_cast<std::size_t>(k)].name +
                            ".reaction");
    table.values.col(1 + muscles + i) = trajectory.reaction.row(k).transpose();
  }
  return table;
}

}  // namespace bio
