#include <fmt/format.h>

#include <algorithm>

#include "simulation/switch_crossing.h"
#include "simulation/system_dynamics.h"

namespace bio::stepping {
namespace {

/// Speeds and lengths beyond these are no motion of a system any more.
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

/// The work done; without muscles, where a free swing has none, with the kinetic energy.
double workOf(const MusculoskeletalSystem& system, const Trajectory& motion) {
  const double work = motion.muscleWork.cwiseAbs().maxCoeff() +
                      motion.passiveWork.cwiseAbs().maxCoeff() +
                      motion.externalWork.cwiseAbs().maxCoeff();
  if (system.numMuscles() > 0) return work;
  double kinetic = 0;
  const Eigen::Index every = 1 + motion.q.cols() / 1000;
  for (Eigen::Index k = 0; k < motion.q.cols(); k += every)
    kinetic = std::max(kinetic, energyOf(system, motion.q.col(k), motion.qDot.col(k)).kinetic);
  return work + kinetic;
}

/// Very long steps leap over the stiff states; then the energy gives them away.
void cutWhereEnergyIsMadeUp(const MusculoskeletalSystem& system, Trajectory& motion, double step) {
  const Eigen::VectorXd imbalance = energyImbalance(system, motion);
  const double work = workOf(system, motion);
  for (Eigen::Index k = 0; k < imbalance.size(); ++k) {
    if (std::abs(imbalance[k]) <= largestEnergyError * work) continue;
    motion.outcome = Outcome::unstable;
    motion.failedAt = motion.time[static_cast<std::size_t>(k)];
    motion.why = fmt::format(
        "unstable at t = {:.6g} s: with a step of {:.3g} s the energy balance is violated by "
        "{:.3g} J for {:.3g} J of work",
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

/// The classical step of fourth order; its first stage serves steps of several lengths.
template <int N>
class ExplicitStep {
 public:
  using State = Eigen::VectorXd;
  using Power = typename SystemDynamics<N>::Power;

  explicit ExplicitStep(SystemDynamics<N>& dynamics, const State& y)
      : dynamics_(dynamics), stage_(y), k1_(y), k2_(y), k3_(y), k4_(y) {}

  void begin(double t, const State& y) { p1_ = dynamics_.derivative(t, y, k1_); }

  /// From y at t to `end` at t + h, after begin(t, y); returns the works.
  Power finish(double t, double h, const State& y, State& end) {
    stage_ = y + h / 2 * k1_;
    const Power p2 = dynamics_.derivative(t + h / 2, stage_, k2_);
    stage_ = y + h / 2 * k2_;
    const Power p3 = dynamics_.derivative(t + h / 2, stage_, k3_);
    stage_ = y + h * k3_;
    const Power p4 = dynamics_.derivative(t + h, stage_, k4_);
    end = y + h / 6 * (k1_ + 2 * k2_ + 2 * k3_ + k4_);
    const auto mean = [&](double Power::*of) {
      return h / 6 * (p1_.*of + 2 * p2.*of + 2 * p3.*of + p4.*of);
    };
    return {mean(&Power::muscle), mean(&Power::passive), mean(&Power::external)};
  }

 private:
  SystemDynamics<N>& dynamics_;
  State stage_, k1_, k2_, k3_, k4_;
  Power p1_;
};

/// A whole motion in steps of one length, which end where a path gains or loses points.
template <int N>
class ExplicitRun {
 public:
  using State = Eigen::VectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;

  ExplicitRun(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
              const SystemState& start, const SimulationOptions& options)
      : system_(system),
        options_(options),
        dynamics_(system, excitation, options.externalForce, options.prescribed),
        y_(dynamics_.pack(start)),
        end_(y_),
        step_(dynamics_, y_),
        stability_(system.numMuscles()),
        recorder_(system, numRows(options)) {
    dynamics_.place(options.startTime, y_);
    hold(dynamics_.coordinates(y_));
  }

  Trajectory run() {
    const StopWatch watch;
    const std::size_t rows = numRows(options_);
    Trajectory& trajectory = recorder_.trajectory();
    record(options_.startTime);
    for (std::size_t k = 1; k < rows; ++k) {
      const double t = rowTime(options_, k - 1);
      const double h = rowTime(options_, k) - t;
      if (!advance(t, h)) break;
      ++trajectory.steps;
      record(t + h);
      if (options_.progress && !options_.progress(t + h)) {
        trajectory.outcome = Outcome::stopped;
        trajectory.failedAt = t + h;
        trajectory.why = fmt::format("stopped at t = {:.6g} s", t + h);
        break;
      }
    }
    trajectory.wallSeconds = watch.seconds();
    Trajectory result = recorder_.finish();
    if (result.outcome == Outcome::completed)
      cutWhereEnergyIsMadeUp(system_, result, options_.step);
    return result;
  }

 private:
  template <class At>
  void hold(const At& at) {
    held_ = at;
    if (!system_.switches().empty()) dynamics_.holdConditions(held_);
  }

  void record(double t) {
    dynamics_.place(t, y_);
    const auto n = static_cast<Eigen::Index>(system_.numMuscles());
    recorder_.add(t, dynamics_.coordinates(y_), dynamics_.speeds(y_), dynamics_.activations(y_),
                  y_.tail(n), work_.muscle, work_.passive, work_.external);
  }

  /// Moves y_ from t to t + h; false where that is no motion any more.
  bool advance(double t, double h) {
    step_.begin(t, y_);
    const std::size_t runaway = stability_.update(h, dynamics_);
    if (runaway < system_.numMuscles()) {
      return fail(t,
                  fmt::format("a step of {:.3g} s is beyond the limit of stability for the "
                              "fibre of '{}' (h|∂V/∂ℓ| = {:.3g}, must stay below {})",
                              options_.step, system_.muscles()[runaway].name,
                              -h * dynamics_.rate(runaway).dV_dFibreLength, FibreStability::limit),
                  t);
    }
    double done = 0;
    for (int parts = 0; done < h; ++parts) {
      if (parts > 0) step_.begin(t + done, y_);
      const double part = h - done;
      auto work = step_.finish(t + done, part, y_, end_);
      const PathSwitch* met = parts < mostSwitchesInAStep ? crossed() : nullptr;
      double taken = part;
      if (met) {
        const auto distance = [&](const State& y) { return met->distance(y[met->freeIndex]); };
        const double before = met->distance(held_[met->freeIndex]);
        taken = crossingOf(part, before, distance(y_), distance(end_), [&](double x) {
          work = step_.finish(t + done, x, y_, end_);
          return distance(end_);
        });
        hold(beyondSwitch(*met, Vector(dynamics_.coordinates(end_)), before));
      } else {
        hold(dynamics_.coordinates(end_));
      }
      y_.swap(end_);
      work_.muscle += work.muscle;
      work_.passive += work.passive;
      work_.external += work.external;
      if (!met) break;
      done += taken;
    }
    if (y_.allFinite() && dynamics_.speeds(y_).cwiseAbs().maxCoeff() < largestSpeed) {
      return true;
    }
    return fail(
        t,
        fmt::format("{} with a step of {:.3g} s",
                    y_.allFinite() ? fmt::format("the speed exceeds {:.0f} rad/s", largestSpeed)
                                   : whyNotANumber(),
                    options_.step),
        t + h);
  }

  const PathSwitch* crossed() const {
    return firstCrossed(system_.switches(), held_, dynamics_.coordinates(y_),
                        dynamics_.coordinates(end_));
  }

  std::string whyNotANumber() const {
    if (dynamics_.lostAt().size() > 0) return describeLostPath(system_, dynamics_.lostAt());
    return "a muscle fibre left its valid domain (not a number)";
  }

  bool fail(double failedAt, const std::string& how, double at) {
    Trajectory& trajectory = recorder_.trajectory();
    trajectory.outcome = Outcome::unstable;
    trajectory.failedAt = failedAt;
    trajectory.why = fmt::format("unstable at t = {:.6g} s: {}", at, how);
    return false;
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  SystemDynamics<N> dynamics_;
  State y_, end_;
  ExplicitStep<N> step_;
  FibreStability stability_;
  Recorder recorder_;
  Vector held_;
  typename SystemDynamics<N>::Power work_;
};

}  // namespace

Trajectory simulateRungeKutta4(const MusculoskeletalSystem& system,
                               const ExcitationSignal& excitation, const SystemState& start,
                               const SimulationOptions& options) {
  return withCoordinates(system.skeleton(), [&](auto N) {
    return ExplicitRun<decltype(N)::value>(system, excitation, start, options).run();
  });
}

}  // namespace bio::stepping
