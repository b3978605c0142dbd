#pragma once

// Pieces shared by the integrators of coupled.h; not part of the public interface.

#include <chrono>
#include <string>

#include "bio/simulation/simulate.h"

namespace bio::stepping {

/// Calls function(std::integral_constant<int, N>) with N = 1 for one free coordinate, or
/// Eigen::Dynamic for a skeleton that is evaluated as a tree.
template <class F>
decltype(auto) withCoordinates(const Skeleton& skeleton, F&& function) {
  if (skeleton.tree()) return function(std::integral_constant<int, Eigen::Dynamic>{});
  return function(std::integral_constant<int, 1>{});
}

/// Trajectory with room for `rows` rows, filled from the front.
class Recorder {
 public:
  Recorder(const MusculoskeletalSystem& system, std::size_t rows) {
    const auto n = static_cast<Eigen::Index>(system.numMuscles());
    const auto N = static_cast<Eigen::Index>(system.skeleton().numCoordinates());
    const auto K = static_cast<Eigen::Index>(rows);
    trajectory_.time.reserve(rows);
    trajectory_.q.resize(N, K);
    trajectory_.qDot.resize(N, K);
    trajectory_.activation.resize(n, K);
    trajectory_.fibreLength.resize(n, K);
    trajectory_.muscleWork.resize(K);
    trajectory_.passiveWork.resize(K);
    trajectory_.externalWork.resize(K);
  }

  template <class Q, class QDot, class A, class L>
  void add(double time, const Q& q, const QDot& qDot, const A& activation, const L& fibreLength,
           double muscleWork, double passiveWork, double externalWork) {
    const auto k = static_cast<Eigen::Index>(trajectory_.time.size());
    trajectory_.time.push_back(time);
    trajectory_.q.col(k) = q;
    trajectory_.qDot.col(k) = qDot;
    trajectory_.activation.col(k) = activation;
    trajectory_.fibreLength.col(k) = fibreLength;
    trajectory_.muscleWork[k] = muscleWork;
    trajectory_.passiveWork[k] = passiveWork;
    trajectory_.externalWork[k] = externalWork;
  }

  /// Cuts the unused columns off.
  Trajectory finish() {
    const auto K = static_cast<Eigen::Index>(trajectory_.time.size());
    trajectory_.q.conservativeResize(Eigen::NoChange, K);
    trajectory_.qDot.conservativeResize(Eigen::NoChange, K);
    trajectory_.activation.conservativeResize(Eigen::NoChange, K);
    trajectory_.fibreLength.conservativeResize(Eigen::NoChange, K);
    trajectory_.muscleWork.conservativeResize(K);
    trajectory_.passiveWork.conservativeResize(K);
    trajectory_.externalWork.conservativeResize(K);
    return std::move(trajectory_);
  }

  Trajectory& trajectory() { return trajectory_; }

 private:
  Trajectory trajectory_;
};

/// Number of output rows of a fixed step, the start included; the last step may be shorter.
inline std::size_t numRows(const SimulationOptions& options) {
  return static_cast<std::size_t>(std::ceil(options.duration / options.step - 1e-9)) + 1;
}

/// Time of row k, the end exactly.
inline double rowTime(const SimulationOptions& options, std::size_t k) {
  return options.startTime + std::min(static_cast<double>(k) * options.step, options.duration);
}

/// Seconds since construction.
class StopWatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The requirements of simulate() on its arguments. @throws std::invalid_argument
void checkSimulation(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                     const SystemState& start, const SimulationOptions& options);

/// One line that names the first muscle whose path has no taut string in a posture, why, and the
/// posture; empty: each path has one.
std::string describeLostPath(const MusculoskeletalSystem& system, const Eigen::VectorXd& q);

/// Fills in what follows from the rest of a motion: fibre lengths where the tendon is rigid, and
/// activations that are the excitation.
void completeStates(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                    Trajectory& motion);

/// Adds the reactions of the prescribed coordinates to a motion; to one of the variational
/// integrators, which do not sum it up themselves, also their work by the trapezoidal rule.
void addReactions(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                  const SimulationOptions& options, Trajectory& motion);

/// The options with the system's optimal forces in the external force; `own` holds them where that
/// differs.
const SimulationOptions& withOwnForces(const MusculoskeletalSystem& system,
                                       const SimulationOptions& options, SimulationOptions& own);
/// Whether it does.
bool changesForces(const MusculoskeletalSystem& system, const SimulationOptions& options);

class StepTape;

/// @param tape takes down every part of a step that was accepted, for sensitivities; may be null
Trajectory simulateVariational(const MusculoskeletalSystem& system,
                               const ExcitationSignal& excitation, const SystemState& start,
                               const SimulationOptions& options, StepTape* tape = nullptr);
Trajectory simulateRungeKutta4(const MusculoskeletalSystem& system,
                               const ExcitationSignal& excitation, const SystemState& start,
                               const SimulationOptions& options);
Trajectory simulateCvode(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                         const SystemState& start, const SimulationOptions& options);

}  // namespace bio::stepping
