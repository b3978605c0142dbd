#include <fmt/format.h>

#include <limits>
#include <optional>

#include "simulation/activation_player.h"
#include "simulation/step_control.h"
#include "simulation/step_tape.h"
#include "simulation/switch_jump.h"
#include "simulation/switch_search.h"
#include "simulation/variational_step.h"

namespace bio::stepping {
namespace {

/// A whole motion, step by step: first guesses, halved steps, steps that end where a path switches.
template <int N>
class VariationalRun {
 public:
  using Stepper = VariationalStepper<N>;
  using Ends = typename Stepper::Ends;
  using Vector = typename Stepper::Vector;

  VariationalRun(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                 const SystemState& start, const SimulationOptions& options, StepTape* tape)
      : system_(system),
        options_(options),
        tape_(tape),
        stepper_(system, options),
        player_(system, excitation, options.startTime),
        configuration_(system),
        search_(options.newtonTolerance),
        recorder_(system, numRows(options)),
        activation_(start.activation),
        middle_(start.activation),
        last_{LastEnds<Vector>(start.qDot),
              LastEnds<Eigen::VectorXd>(Eigen::VectorXd::Zero(start.fibreLength.size())),
              {options.step, options.step}},
        control_(system, options),
        keptActivation_(static_cast<std::size_t>(options.maxHalvings) + 1, start.activation) {
    now_.q = start.q;
    options.prescribed.place(options.startTime, now_.q, last_.q.velocity);
    last_.q.velocityBefore = last_.q.velocity;
    configuration_.moveTo(now_.q);
    now_.p = configuration_.massMatrix() * last_.q.velocity;
    now_.fibreLength = start.fibreLength;
    next_ = now_;
    if (!system_.switches().empty()) sides_.emplace(system_);
    recorder_.add(options.startTime, now_.q, last_.q.velocity, activation_, now_.fibreLength, 0, 0,
                  0);
    if (tape_) tape_->begin(now_.q, now_.fibreLength, activation_, numRows(options_));
  }

  Trajectory run() {
    const StopWatch watch;
    const std::size_t rows = numRows(options_);
    Trajectory& trajectory = recorder_.trajectory();
    TimeMark begin = markRow(rowTime(options_, 0));
    for (std::size_t k = 1; k < rows; ++k) {
      const TimeMark end = markRow(rowTime(options_, k));
      const double t0 = begin.value;
      const double t1 = end.value;
      if (!advance(begin, end, 0)) {
        trajectory.outcome = Outcome::noSolution;
        trajectory.failedAt = t0;
        trajectory.why = fmt::format(
            "no solution at t = {:.6g} s: the smallest step, {:.3g} s, did not converge ({})", t0,
            (t1 - t0) / std::pow(2, options_.maxHalvings), stepper_.describeFailure());
        break;
      }
      begin = end;
      trajectory.steps = control_.isUsed() ? parts_ : static_cast<long>(k);
      if (tape_) tape_->endRow();
      recorder_.add(t1, now_.q, speed(t1), activation_, now_.fibreLength, muscleWork_, passiveWork_,
                    externalWork_);
      if (options_.progress && !options_.progress(t1)) {
        trajectory.outcome = Outcome::stopped;
        trajectory.failedAt = t1;
        trajectory.why = fmt::format("stopped at t = {:.6g} s", t1);
        break;
      }
    }
    trajectory.wallSeconds = watch.seconds();
    return recorder_.finish();
  }

 private:
  /// Moves now_ and activation_ from t0 to t1; in halves, and halves of them, where Newton fails, a
  /// length has just jumped or the error would be too large, and in two parts where a conditional
  /// path point comes or goes. One that comes or goes very near to an end of the step does so at
  /// that end.
  bool advance(const TimeMark& begin, const TimeMark& end, int depth) {
    const double t0 = begin.value;
    const double t1 = end.value;
    if (t1 - t0 > longestStepAfterJump(t0 - lastJump_)) return inHalves(begin, end, depth);
    const bool mayBeHalved = depth < options_.maxHalvings;
    if (mayBeHalved && control_.isTooLong(t1 - t0)) return inHalves(begin, end, depth + 1);
    Eigen::VectorXd& kept = keptActivation_[static_cast<std::size_t>(depth)];
    kept = activation_;
    if (!solve(t0, t1)) {
      if (!mayBeHalved) return false;
      if (depth == 0 || control_.isUsed()) ++recorder_.trajectory().halvedSteps;
      goBack(t0, kept);
      return inHalves(begin, end, depth + 1);
    }
    double split = t1;
    const PathSwitch* met = findSwitch(t0, t1, kept, split);
    if (met == nullptr && search_.isAtBegin() && lastJump_ != t0 && jumps()) {
      lastJump_ = t0;
      goBack(t0, kept);
      return advance(begin, end, depth);
    }
    const double solved = met == nullptr ? t1 : split;
    if (!control_.accepts(solved - t0, now_, next_, last_) && mayBeHalved) {
      goBack(t0, kept);
      return inHalves(begin, end, depth + 1);
    }
    if (met == nullptr) {
      const bool jumpsAtEnd = search_.isAtEnd() && jumps();
      accept(begin, end);
      if (jumpsAtEnd) lastJump_ = t1;
      return true;
    }
    const TimeMark middle = markSwitch(split, *met);
    accept(begin, middle);
    if (sides_->lengthJumps(*met, now_.q)) lastJump_ = split;
    return advance(middle, end, depth);
  }

  bool inHalves(const TimeMark& begin, const TimeMark& end, int depth) {
    const TimeMark middle = markMiddle(begin, end);
    return advance(begin, middle, depth) && advance(middle, end, depth);
  }

  /// Activations as at the time t0 of now_.
  void goBack(double t0, const Eigen::VectorXd& activation) {
    activation_ = activation;
    player_.restart(t0);
  }

  /// Whether a length does at the switch that the step just solved crosses.
  bool jumps() { return sides_->lengthJumps(search_.which(), now_.q, next_.q); }

  TimeMark markRow(double time) { return {time, tape_ ? tape_->addRow(time) : 0}; }
  TimeMark markSwitch(double time, const PathSwitch& met) {
    return {time, tape_ ? tape_->addSwitch(time, met) : 0};
  }
  TimeMark markMiddle(const TimeMark& begin, const TimeMark& end) {
    const double time = begin.value + (end.value - begin.value) / 2;
    return {time, tape_ ? tape_->addMiddle(time, begin.index, end.index) : 0};
  }

  /// One step from now_ into next_, activation_ moved along.
  bool solve(double t0, double t1) {
    const double h = t1 - t0;
    const double tMiddle = t0 + h / 2;
    player_.advance(t0, tMiddle, activation_);
    middle_ = activation_;
    player_.advance(tMiddle, t1, activation_);
    const GuessWeights weights = last_.lengths.weights(h);
    next_.q = last_.q.guess(weights, now_.q);
    next_.fibreLength = last_.fibreLength.guess(weights, now_.fibreLength);
    options_.prescribed.place(t1, next_.q);
    result_ = stepper_.solve(h, tMiddle, now_, middle_, next_);
    count(result_.iterations);
    if (!result_.converged) {  // again from rest, in case the extrapolation was the trouble
      next_.q = now_.q;
      options_.prescribed.place(t1, next_.q);
      next_.fibreLength = now_.fibreLength;
      result_ = stepper_.solve(h, tMiddle, now_, middle_, next_);
      count(result_.iterations);
    }
    return result_.converged;
  }

  /// If a path gains or loses points within the step just solved: shortens the step to end there.
  /// Returns which switch it then ends on, or null.
  const PathSwitch* findSwitch(double t0, double t1, const Eigen::VectorXd& activationAtStart,
                               double& split) {
    if (!search_.begin(system_.switches(), now_.q, next_.q)) return nullptr;
    for (auto found = SwitchSearch::Found::again; found == SwitchSearch::Found::again;) {
      split = t0 + search_.fraction() * (t1 - t0);
      goBack(t0, activationAtStart);
      if (!solve(t0, split)) break;
      found = search_.take(next_.q[search_.which().freeIndex]);
      if (found == SwitchSearch::Found::met) return &search_.which();
    }
    // not to be met exactly: take the whole step as it is
    goBack(t0, activationAtStart);
    solve(t0, t1);
    return nullptr;
  }

  /// next_ becomes now_.
  void accept(const TimeMark& begin, const TimeMark& end) {
    const double h = end.value - begin.value;
    if (tape_) tape_->add(begin.index, end.index, next_.q, next_.fibreLength, middle_, activation_);
    control_.take(last_);
    ++parts_;
    last_.q.add(h, last_.lengths, now_.q, next_.q);
    last_.fibreLength.add(h, last_.lengths, now_.fibreLength, next_.fibreLength);
    last_.lengths.add(h);
    now_.q.swap(next_.q);
    now_.p.swap(next_.p);
    now_.fibreLength.swap(next_.fibreLength);
    muscleWork_ += result_.muscleWork;
    passiveWork_ += result_.passiveWork;
    externalWork_ += result_.externalWork;
  }

  void count(int iterations) {
    recorder_.trajectory().newtonIterations += std::min(iterations, options_.maxIterations);
  }

  /// q̇ = M⁻¹p at the end of the last step, at time t; of prescribed coordinates as given.
  const Vector& speed(double t) {
    if (!system_.skeleton().hasConstantInertia()) configuration_.moveSkeletonTo(now_.q);
    if (system_.prescribed().empty()) {
      factor_.compute(configuration_.massMatrix());
      speed_ = factor_.solve(now_.p);
      return speed_;
    }
    massMatrix_ = configuration_.massMatrix();
    momentum_ = now_.p;
    speed_ = now_.p;
    options_.prescribed.place(t, now_.q, speed_);  // the values stay as they are
    for (const int k : system_.prescribed()) momentum_ -= massMatrix_.col(k) * speed_[k];
    for (const int k : system_.prescribed()) momentum_[k] = speed_[k];
    decouple(system_.prescribed(), massMatrix_);
    factor_.compute(massMatrix_);
    speed_ = factor_.solve(momentum_);
    return speed_;
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  StepTape* tape_;
  Stepper stepper_;
  ActivationPlayer player_;
  SystemConfiguration<N> configuration_;
  SwitchSearch search_;
  Recorder recorder_;
  Eigen::VectorXd activation_, middle_;
  Ends now_, next_;
  LastParts<N> last_;
  StepControl<N> control_;
  Vector speed_, momentum_;
  Eigen::Matrix<double, N, N> massMatrix_;
  Eigen::LDLT<Eigen::Matrix<double, N, N>> factor_;
  std::optional<SwitchSides<N>> sides_;                         ///< where there are switches
  double lastJump_ = -std::numeric_limits<double>::infinity();  ///< [s]
  long parts_ = 0;
  double muscleWork_ = 0;
  double passiveWork_ = 0;
  double externalWork_ = 0;
  std::vector<Eigen::VectorXd> keptActivation_;  ///< one per depth of halving
  typename Stepper::Result result_;
};

}  // namespace

Trajectory simulateVariational(const MusculoskeletalSystem& system,
                               const ExcitationSignal& excitation, const SystemState& start,
                               const SimulationOptions& options, StepTape* tape) {
  return withCoordinates(system.skeleton(), [&](auto N) {
    return VariationalRun<decltype(N)::value>(system, excitation, start, options, tape).run();
  });
}

}  // namespace bio::stepping
