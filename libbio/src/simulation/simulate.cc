#include "bio/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/integrators.h"
#include "simulation/moved_mass.h"

namespace bio {

namespace {

constexpr double sameTime = 1e-9;  ///< [s]

}  // namespace

SystemState initialState(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                         const ExcitationSignal& excitation, double time) {
  const auto n = static_cast<Eigen::Index>(system.numMuscles());
  if (q.size() != system.skeleton().numCoordinates() || !q.allFinite()) {
    throw std::invalid_argument(fmt::format("start: {} coordinates, must be {} finite values",
                                            q.size(), system.skeleton().numCoordinates()));
  }
  if (excitation.numMuscles() != n) {
    throw std::invalid_argument(fmt::format("excitations: {} columns, the system has {} muscles",
                                            excitation.numMuscles(), n));
  }
  SystemState state;
  state.q = q;
  state.qDot = Eigen::VectorXd::Zero(q.size());
  state.activation.resize(n);
  std::size_t hint = 0;
  excitation.at(time, hint, state.activation);
  for (Eigen::Index i = 0; i < n; ++i) {
    double& activation = state.activation[i];
    activation = system.muscles()[static_cast<std::size_t>(i)].activation.start(activation).value;
  }
  state.fibreLength.resize(n);
  stepping::withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    configuration.moveTo(q);
    for (std::size_t i = 0; i < system.numMuscles(); ++i) {
      const auto si = static_cast<Eigen::Index>(i);
      const double length = configuration.length(i).length;
      if (std::isnan(length)) {
        if (const std::string lost = stepping::describeLostPath(system, q); !lost.empty()) {
          throw NoStaticEquilibrium(fmt::format("at the start, {} s: {}", time, lost));
        }
      }
      if (!std::isfinite(length)) {
        throw NoStaticEquilibrium(
            fmt::format("muscle '{}': muscle–tendon length at the start = {} m, must be finite",
                        system.muscles()[i].name, length));
      }
      const StaticEquilibrium rest = system.muscles()[i].muscle.rest(state.activation[si], length);
      if (!rest.isUsable()) {
        throw NoStaticEquilibrium(fmt::format(
            "muscle '{}': no static equilibrium at the start with length {:.6g} m and activation "
            "{:.4g}: {}",
            system.muscles()[i].name, length, state.activation[si], describe(rest.why)));
      }
      state.fibreLength[si] = rest.fibreLength;
    }
  });
  return state;
}

std::string stepping::describeLostPath(const MusculoskeletalSystem& system,
                                       const Eigen::VectorXd& q) {
  if (!q.allFinite()) return {};
  return withCoordinates(system.skeleton(), [&](auto N) -> std::string {
    SystemConfiguration<decltype(N)::value> configuration(system);
    configuration.moveTo(q);
    for (std::size_t i = 0; i < system.numPaths(); ++i) {
      if (!std::isnan(configuration.length(i).length)) continue;
      const bool isMuscle = i < system.numMuscles();
      return fmt::format(
          "{} '{}': its path has no taut string over its wrap objects at {}",
          isMuscle ? "muscle" : "elastic path",
          isMuscle ? system.muscles()[i].name : system.elasticPaths()[i - system.numMuscles()].name,
          describePosture(system.skeleton(), q));
    }
    return {};
  });
}

void stepping::checkSimulation(const MusculoskeletalSystem& system,
                               const ExcitationSignal& excitation, const SystemState& start,
                               const SimulationOptions& options) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(options.step > 0 && std::isfinite(options.step),
          fmt::format("step = {} s, must be > 0", options.step));
  require(options.duration > 0 && std::isfinite(options.duration),
          fmt::format("duration = {} s, must be > 0", options.duration));
  require(
      options.duration / options.step < 1e8,
      fmt::format("duration/step = {:.3g} steps, must be < 1e8", options.duration / options.step));
  const double furthest =
      std::max(std::abs(options.startTime), std::abs(options.startTime + options.duration));
  require(options.step > 1e-9 * furthest,
          fmt::format("time up to {} s, must be below 1e9 steps of {} s: otherwise successive "
                      "times cannot be distinguished",
                      furthest, options.step));
  require(options.maxHalvings >= 0 && options.maxHalvings <= 40,
          fmt::format("maxHalvings = {}, must be 0 to 40", options.maxHalvings));
  require(options.newtonTolerance > 0, "newtonTolerance must be > 0");
  const auto n = static_cast<Eigen::Index>(system.numMuscles());
  const Eigen::Index N = system.skeleton().numCoordinates();
  require(start.q.size() == N && start.qDot.size() == N && start.activation.size() == n &&
              start.fibreLength.size() == n && excitation.numMuscles() == n,
          fmt::format(
              "start state or excitations do not fit a system with {} coordinates and {} muscles",
              N, n));
  require(start.q.allFinite() && start.qDot.allFinite() && start.activation.allFinite() &&
              start.fibreLength.allFinite(),
          "start state: a value is not finite");
  if (system.isSingularInDefaultPosture()) {
    const std::string singular = whatMovesNoMassAt(system.skeleton(), start.q);
    require(
        singular.empty(),
        singular + " in the posture at the start, must not: start elsewhere, or lock a coordinate");
  }
  require(options.externalForce.empty() || options.externalForce.numCoordinates() == N,
          fmt::format("external force: {} columns, the system has {} free coordinates",
                      options.externalForce.numCoordinates(), N));
  std::vector<int> given;
  for (const PrescribedMotion::Course& course : options.prescribed.courses()) {
    given.push_back(course.coordinate);
    const bool covers = course.first <= options.startTime + sameTime &&
                        course.last >= options.startTime + options.duration - sameTime;
    require(covers,
            fmt::format("prescribed motion: given from {:.6g} s to {:.6g} s, must cover the "
                        "simulation from {:.6g} s to {:.6g} s",
                        course.first, course.last, options.startTime,
                        options.startTime + options.duration));
  }
  std::sort(given.begin(), given.end());
  require(given == system.prescribed(),
          "prescribed motion: must be given for the prescribed coordinates of the system, and no "
          "other");
}

bool stepping::changesForces(const MusculoskeletalSystem& system,
                             const SimulationOptions& options) {
  for (const ExternalForce::Control& control : options.externalForce.controls()) {
    for (const CoordinateActuator& actuator : system.actuators()) {
      if (actuator.name == control.actuator && actuator.optimalForce != control.optimalForce) {
        return true;
      }
    }
  }
  return false;
}

const SimulationOptions& stepping::withOwnForces(const MusculoskeletalSystem& system,
                                                 const SimulationOptions& options,
                                                 SimulationOptions& own) {
  if (!changesForces(system, options)) return options;
  std::map<std::string, double> forces;
  for (const CoordinateActuator& actuator : system.actuators()) {
    forces[actuator.name] = actuator.optimalForce;
  }
  own = options;
  own.externalForce = options.externalForce.withOptimalForces(forces);
  return own;
}

Trajectory simulate(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                    const SystemState& start, const SimulationOptions& given) {
  stepping::checkSimulation(system, excitation, start, given);
  SimulationOptions own;
  const SimulationOptions& options = stepping::withOwnForces(system, given, own);
  const auto run = [&] {
    switch (options.integrator) {
      case Integrator::variational:
      case Integrator::variationalLeft:
      case Integrator::variationalAdaptive:
        return stepping::simulateVariational(system, excitation, start, options);
      case Integrator::rungeKutta4:
        return stepping::simulateRungeKutta4(system, excitation, start, options);
      case Integrator::cvode:
        return stepping::simulateCvode(system, excitation, start, options);
    }
    throw std::invalid_argument("unknown integrator");
  };
  Trajectory motion = run();
  stepping::completeStates(system, excitation, motion);
  stepping::addReactions(system, excitation, options, motion);
  return motion;
}

void stepping::completeStates(const MusculoskeletalSystem& system,
                              const ExcitationSignal& excitation, Trajectory& motion) {
  const auto rows = static_cast<Eigen::Index>(motion.time.size());
  std::vector<std::size_t> direct, rigid;
  for (std::size_t i = 0; i < system.numMuscles(); ++i) {
    if (system.muscles()[i].activation.isDirect()) direct.push_back(i);
    if (!system.muscles()[i].muscle.hasFibreState()) rigid.push_back(i);
  }
  if (!direct.empty()) {
    Eigen::VectorXd u(excitation.numMuscles());
    std::size_t hint = 0;
    for (Eigen::Index k = 0; k < rows; ++k) {
      excitation.at(motion.time[static_cast<std::size_t>(k)], hint, u);
      for (const std::size_t i : direct) {
        const auto si = static_cast<Eigen::Index>(i);
        motion.activation(si, k) = system.muscles()[i].activation.acting(u[si], 0);
      }
    }
  }
  if (rigid.empty()) return;
  withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    for (Eigen::Index k = 0; k < rows; ++k) {
      configuration.moveTo(motion.q.col(k));
      for (const std::size_t i : rigid) {
        motion.fibreLength(static_cast<Eigen::Index>(i), k) =
            system.muscles()[i].muscle.rigidRate(0, configuration.length(i).length, 0).fibreLength;
      }
    }
  });
}

namespace {

template <int N>
Energy energyAt(SystemConfiguration<N>& configuration, const Eigen::Matrix<double, N, 1>& q,
                const Eigen::Matrix<double, N, 1>& qDot, Eigen::Matrix<double, N, 1>& momentum) {
  configuration.moveSkeletonTo(q);
  momentum.noalias() = configuration.massMatrix() * qDot;
  return {qDot.dot(momentum) / 2, configuration.potential()};
}

}  // namespace

Energy energyOf(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                const Eigen::VectorXd& qDot) {
  return stepping::withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    Eigen::Matrix<double, decltype(N)::value, 1> momentum = q;
    return energyAt<decltype(N)::value>(configuration, q, qDot, momentum);
  });
}

Eigen::VectorXd energyImbalance(const MusculoskeletalSystem& system, const Trajectory& trajectory) {
  return stepping::withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    Eigen::VectorXd imbalance(trajectory.q.cols());
    double first = 0;
    Eigen::Matrix<double, decltype(N)::value, 1> q = system.skeleton().defaultValues();
    Eigen::Matrix<double, decltype(N)::value, 1> qDot = q, momentum = q;
    for (Eigen::Index k = 0; k < trajectory.q.cols(); ++k) {
      q = trajectory.q.col(k);
      qDot = trajectory.qDot.col(k);
      const Energy energy = energyAt<decltype(N)::value>(configuration, q, qDot, momentum);
      const double stored = energy.kinetic + energy.potential;
      if (k == 0) first = stored;
      imbalance[k] = stored - first - trajectory.muscleWork[k] - trajectory.passiveWork[k] -
                     trajectory.externalWork[k];
    }
    return imbalance;
  });
}

double energyError(const MusculoskeletalSystem& system, const Trajectory& trajectory) {
  return energyImbalance(system, trajectory).cwiseAbs().maxCoeff();
}

MuscleReport reportMuscles(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                           int coordinate) {
  if (coordinate < 0 || coordinate >= system.skeleton().numCoordinates()) {
    throw std::invalid_argument(
        fmt::format("coordinate {} of {}", coordinate, system.skeleton().numCoordinates()));
  }
  const auto n = static_cast<Eigen::Index>(system.numMuscles());
  const Eigen::Index K = trajectory.q.cols();
  const auto mustBe = [K](const Eigen::MatrixXd& values, Eigen::Index rows, const char* what) {
    if (values.rows() == rows && values.cols() == K) return;
    throw std::invalid_argument(fmt::format("{} of the trajectory: {} × {}, must be {} × {}", what,
                                            values.rows(), values.cols(), rows, K));
  };
  mustBe(trajectory.q, system.skeleton().numCoordinates(), "coordinates");
  mustBe(trajectory.fibreLength, n, "fibre lengths");
  const bool anyIsRigid =
      std::any_of(system.muscles().begin(), system.muscles().end(),
                  [](const SystemMuscle& each) { return !each.muscle.hasFibreState(); });
  if (anyIsRigid) {  // its force follows from activation and speed
    mustBe(trajectory.qDot, system.skeleton().numCoordinates(), "speeds");
    mustBe(trajectory.activation, n, "activations");
  }
  MuscleReport report;
  report.tendonForce.resize(n, K);
  report.muscleTendonLength.resize(n, K);
  report.momentArm.resize(n, K);
  stepping::withCoordinates(system.skeleton(), [&](auto N) {
    SystemConfiguration<decltype(N)::value> configuration(system);
    for (Eigen::Index k = 0; k < K; ++k) {
      configuration.moveTo(trajectory.q.col(k));
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto& length = configuration.length(static_cast<std::size_t>(i));
        report.muscleTendonLength(i, k) = length.length;
        report.momentArm(i, k) = -length.dL_dq[coordinate];
        const SimulatedMuscle& muscle = system.muscles()[static_cast<std::size_t>(i)].muscle;
        const bool isRigid = !muscle.hasFibreState();
        report.tendonForce(i, k) = muscle.tendonForce(
            isRigid ? trajectory.activation(i, k) : 0, trajectory.fibreLength(i, k), length.length,
            isRigid ? length.dL_dq.dot(trajectory.qDot.col(k)) : 0);
      }
    }
  });
  return report;
}

}  // namespace bio
