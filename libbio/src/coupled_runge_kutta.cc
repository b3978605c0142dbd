#include <fmt/format.h>

#include "arm_dynamics.h"

namespace bio::stepping {
namespace {

/// Speeds and lengths beyond these are no motion of an arm any more.
constexpr double largestEnergyError = 0.05;  ///< of the work done; 1e-11 on stable runs
constexpr double largestSpeed = 100;         ///< [rad/s] or [m/s]

/// Whether a fibre equation stays beyond the method's limit of stability, h|∂V/∂ℓ| = 2.785. There
/// errors grow from step to step, but the force–velocity relation keeps the oscillation finite, so
/// that the motion looks like one and is wrong. Steps beyond the limit are counted with a memory of
/// 25 steps; four of them are too many. On OpenSim's reference trials there are none up to 3e-4 s.
class FibreStability {
 public:
  static constexpr double limit = 2.785;

  explicit FibreStability(std::size_t muscles) : beyond_(muscles, 0.0) {}

  /// Index of a muscle that has been beyond the limit too often, else the number of muscles.
  template <class Dynamics>
  std::size_t update(double h, const Dynamics& dynamics) {
    for (std::size_t i = 0; i < beyond_.size(); ++i) {
      beyond_[i] = 0.96 * beyond_[i] + (-h * dynamics.rate(i).dV_dFibreLength > limit ? 1 : 0);
      if (beyond_[i] > 4) return i;
    }
    return beyond_.size();
  }

 private:
  std::vector<double> beyond_;
};

/// Very long steps leap over the stiff states; then the energy gives them away.
void cutWhereEnergyIsMadeUp(const Arm& arm, Trajectory& motion, double step) {
  const Eigen::VectorXd imbalance = energyImbalance(arm, motion);
  const double work = motion.muscleWork.cwiseAbs().maxCoeff() +
                      motion.passiveWork.cwiseAbs().maxCoeff() +
                      motion.externalWork.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < imbalance.size(); ++k) {
    if (std::abs(imbalance[k]) <= largestEnergyError * work) continue;
    motion.outcome = Outcome::unstable;
    motion.failedAt = motion.time[static_cast<std::size_t>(k)];
    motion.why = fmt::format(
        "unstable at t = {:.6g} s: with a step of {:.3g} s the energy balance is off by {:.3g} J, "
        "the "
        "work done being {:.3g} J",
        motion.failedAt, step, imbalance[k], work);
    motion.time.resize(static_cast<std::size_t>(k));
    for (Eigen::MatrixXd* rows :
         {&motion.q, &motion.qDot, &motion.activation, &motion.fibreLength}) {
      rows->conservativeResize(Eigen::NoChange, k);
    }
    motion.muscleWork.conservativeResize(k);
    motion.passiveWork.conservativeResize(k);
    motion.externalWork.conservativeResize(k);
    return;
  }
}

template <int N>
Trajectory runExplicit(const Arm& arm, const ExcitationSignal& excitation, const ArmState& start,
                       const SimulationOptions& options) {
  ArmDynamics<N> dynamics(arm, excitation, options.externalForce);
  using State = Eigen::VectorXd;
  State y = dynamics.pack(start);
  State stage = y, k1 = y, k2 = y, k3 = y, k4 = y;
  const auto n = static_cast<Eigen::Index>(arm.numMuscles());
  const std::size_t rows = numRows(options);
  Recorder recorder(arm, rows);
  Trajectory& trajectory = recorder.trajectory();
  double muscleWork = 0;
  double passiveWork = 0;
  double externalWork = 0;
  const auto record = [&](double t) {
    recorder.add(t, y.template head<N>(), y.template segment<N>(N), y.segment(2 * N, n), y.tail(n),
                 muscleWork, passiveWork, externalWork);
  };
  record(options.startTime);
  FibreStability stability(arm.numMuscles());
  const StopWatch watch;
  for (std::size_t k = 1; k < rows; ++k) {
    const double t = rowTime(options, k - 1);
    const double h = rowTime(options, k) - t;
    const auto p1 = dynamics.derivative(t, y, k1);
    const std::size_t runaway = stability.update(h, dynamics);
    if (runaway < arm.numMuscles()) {
      trajectory.outcome = Outcome::unstable;
      trajectory.failedAt = t;
      trajectory.why = fmt::format(
          "unstable at t = {:.6g} s: a step of {:.3g} s is beyond the limit of stability for the "
          "fibre "
          "of '{}' (h|∂V/∂ℓ| = {:.3g}, must stay below {})",
          t, options.step, arm.muscles()[runaway].name, -h * dynamics.rate(runaway).dV_dFibreLength,
          FibreStability::limit);
      break;
    }
    stage = y + h / 2 * k1;
    const auto p2 = dynamics.derivative(t + h / 2, stage, k2);
    stage = y + h / 2 * k2;
    const auto p3 = dynamics.derivative(t + h / 2, stage, k3);
    stage = y + h * k3;
    const auto p4 = dynamics.derivative(t + h, stage, k4);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    muscleWork += h / 6 * (p1.muscle + 2 * p2.muscle + 2 * p3.muscle + p4.muscle);
    passiveWork += h / 6 * (p1.passive + 2 * p2.passive + 2 * p3.passive + p4.passive);
    externalWork += h / 6 * (p1.external + 2 * p2.external + 2 * p3.external + p4.external);
    ++trajectory.steps;
    if (!y.allFinite() || !(y.template segment<N>(N).cwiseAbs().maxCoeff() < largestSpeed)) {
      trajectory.outcome = Outcome::unstable;
      trajectory.failedAt = t;
      trajectory.why =
          fmt::format("unstable at t = {:.6g} s: {} with a step of {:.3g} s", t + h,
                      y.allFinite() ? fmt::format("the speed exceeds {:.0f} rad/s", largestSpeed)
                                    : std::string("a muscle fibre left its domain (not a number)"),
                      options.step);
      break;
    }
    record(t + h);
    if (options.progress && !options.progress(t + h)) {
      trajectory.outcome = Outcome::stopped;
      trajectory.failedAt = t + h;
      trajectory.why = fmt::format("stopped at t = {:.6g} s", t + h);
      break;
    }
  }
  trajectory.wallSeconds = watch.seconds();
  Trajectory result = recorder.finish();
  if (result.outcome == Outcome::completed) cutWhereEnergyIsMadeUp(arm, result, options.step);
  return result;
}

}  // namespace

Trajectory simulateRungeKutta4(const Arm& arm, const ExcitationSignal& excitation,
                               const ArmState& start, const SimulationOptions& options) {
  return withCoordinates(arm.skeleton().numCoordinates(), [&](auto N) {
    return runExplicit<decltype(N)::value>(arm, excitation, start, options);
  });
}

}  // namespace bio::stepping
