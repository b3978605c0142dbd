#include "simulation/simd/lane_driver.h"

#include <cmath>

namespace bio::lanes {

using Eigen::Index;

ActivationCourse::ActivationCourse(const MusculoskeletalSystem& system,
                                   const ExcitationSignal& excitation, const SystemState& start,
                                   const SimulationOptions& options)
    : options_(&options),
      player_(system, excitation, options.startTime),
      middle_(start.activation.size(), static_cast<Index>(stepping::numRows(options))),
      end_(middle_),
      activation_(start.activation) {
  end_.col(0) = middle_.col(0) = activation_;
}

void ActivationCourse::reach(Index k) {
  for (; reached_ < k; ++reached_) {
    const double t0 = stepping::rowTime(*options_, static_cast<std::size_t>(reached_));
    const double t1 = stepping::rowTime(*options_, static_cast<std::size_t>(reached_) + 1);
    const double half = t0 + (t1 - t0) / 2;
    player_.advance(t0, half, activation_);
    middle_.col(reached_ + 1) = activation_;
    player_.advance(half, t1, activation_);
    end_.col(reached_ + 1) = activation_;
  }
}

LaneDriver::LaneDriver(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                       const SystemState& start, const SimulationOptions& options,
                       ActivationCourse& course, double mass)
    : system_(&system),
      options_(&options),
      course_(&course),
      player_(system, excitation, options.startTime),
      recorder_(system, stepping::numRows(options)),
      mass_(mass),
      rows_(stepping::numRows(options)),
      t0_(stepping::rowTime(options, 0)),
      t1_(t0_),
      targets_{{stepping::rowTime(options, 1), 0}},
      q_(start.q[0]),
      p_(mass * start.qDot[0]),
      lengths_{options.step, options.step},
      lastQ_(start.qDot[0]),
      fibre_(start.fibreLength),
      lastFibre_(Eigen::VectorXd::Zero(fibre_.size())),
      activation_(start.activation),
      middle_(activation_),
      kept_(activation_),
      fibreEnd_(fibre_),
      search_(options.newtonTolerance) {
  if (!system.switches().empty()) sides_.emplace(system);
  recorder_.add(options.startTime, start.q, start.qDot, activation_, fibre_, 0, 0, 0);
}

template <class Of>
bool LaneDriver::ask(int lane, LaneStep<Of>& step) {
  if (phase_ == Phase::finished || phase_ == Phase::failed) return false;
  if (phase_ == Phase::wholeStep && !fromRest_) shortenAfterJump();
  if (phase_ != Phase::meetSwitch) t1_ = targets_.back().time;
  if (!fromRest_) {
    if (phase_ == Phase::wholeStep) kept_ = activation_;
    chooseActivation();
  }
  const double h = t1_ - t0_;
  const stepping::GuessWeights weights = fromRest_ ? stepping::GuessWeights() : lengths_.weights(h);
  step.length[lane] = h;
  step.q[lane] = q_;
  step.p[lane] = p_;
  step.qEnd[lane] = lastQ_.guess(weights, q_);
  for (Index i = 0; i < fibre_.size(); ++i) {
    MuscleStep<Of>& muscle = step.muscles[i];
    muscle.fibreLength[lane] = fibre_[i];
    muscle.fibreLengthEnd[lane] = weights.guess(fibre_[i], lastFibre_.velocity[i],
                                                lastFibre_.velocityBefore[i], lastFibre_.third[i]);
    muscle.activation[lane] = middle_[i];
  }
  if (!options_->externalForce.empty()) {
    std::size_t hint = row_ - 1;
    Eigen::Matrix<double, 1, 1> force(0.0);
    options_->externalForce.add(t0_ + h / 2, hint, force);
    step.external[lane] = force[0];
  }
  return true;
}

void LaneDriver::chooseActivation() {
  if (!within_) {
    middle_ = course_->middle(static_cast<Index>(row_));
    activation_ = course_->end(static_cast<Index>(row_));
    return;
  }
  const double half = t0_ + (t1_ - t0_) / 2;
  player_.advance(t0_, half, activation_);
  middle_ = activation_;
  player_.advance(half, t1_, activation_);
}

template <class Of>
void LaneDriver::take(int lane, const LaneStep<Of>& step) {
  recorder_.trajectory().newtonIterations += step.iterations[lane];
  constexpr double furthest = 1e5;  // of what sines are accurate for [rad]
  if (step.converged[lane] == 0) {
    meetFailure();
    return;
  }
  if (!(std::abs(step.qEnd[lane]) < furthest)) {
    phase_ = Phase::failed;
    return;
  }
  fromRest_ = false;
  qEnd_ = step.qEnd[lane];
  pEnd_ = step.pEnd[lane];
  for (Index i = 0; i < fibre_.size(); ++i) fibreEnd_[i] = step.muscles[i].fibreLengthEnd[lane];
  works_[0] = step.muscleWork[lane];
  works_[1] = step.passiveWork[lane];
  works_[2] = step.externalWork[lane];
  takeEnd();
}

void LaneDriver::takeEnd() {
  if (phase_ == Phase::wholeStep && search_.begin(system_->switches(), &q_, &qEnd_)) {
    meetSwitch();
    return;
  }
  if (phase_ == Phase::wholeStep && search_.isAtBegin() && lastJump_ != t0_ && jumps()) {
    lastJump_ = t0_;
    returnToBegin();
    return;
  }
  if (phase_ != Phase::meetSwitch) {
    const bool jumpsAtEnd = phase_ == Phase::wholeStep && search_.isAtEnd() && jumps();
    accept(true);
    if (jumpsAtEnd) lastJump_ = t0_;
    return;
  }
  switch (search_.take(qEnd_)) {
    case stepping::SwitchSearch::Found::met:
      accept(false);
      noteJump();
      return;
    case stepping::SwitchSearch::Found::again:
      meetSwitch();
      return;
    case stepping::SwitchSearch::Found::givenUp:
      jumpSwitch();
  }
}

void LaneDriver::noteJump() {
  const Eigen::Matrix<double, 1, 1> q(q_);
  if (sides_->lengthJumps(search_.which(), q)) lastJump_ = t0_;
}

/// Whether a length does at the switch that the step taken crosses.
bool LaneDriver::jumps() {
  using Number = Eigen::Matrix<double, 1, 1>;
  return sides_->lengthJumps(search_.which(), Number(q_), Number(qEnd_));
}

/// Steps end in the middle of what is too long for them.
void LaneDriver::shortenAfterJump() {
  const double longest = stepping::longestStepAfterJump(t0_ - lastJump_);
  if (!(targets_.back().time - t0_ > longest)) return;
  while (targets_.back().time - t0_ > longest) {
    const Target whole = targets_.back();
    targets_.push_back({t0_ + (whole.time - t0_) / 2, whole.halvings});
  }
  if (within_) return;
  kept_ = activation_;
  returnToBegin();
}

/// Activations are played from the begin of the step.
void LaneDriver::returnToBegin() {
  within_ = true;
  activation_ = kept_;
  player_.restart(t0_);
}

/// The next step goes to where the switch is looked for.
void LaneDriver::meetSwitch() {
  phase_ = Phase::meetSwitch;
  t1_ = t0_ + search_.fraction() * (targets_.back().time - t0_);
  returnToBegin();
}

/// The next step is the whole one, which was solved before.
void LaneDriver::jumpSwitch() {
  phase_ = Phase::jumpSwitch;
  returnToBegin();
}

/// A step that fails is tried again from rest, then in halves.
void LaneDriver::meetFailure() {
  fromRest_ = !fromRest_;
  if (fromRest_) return;
  if (phase_ == Phase::meetSwitch) {
    jumpSwitch();
    return;
  }
  Target& target = targets_.back();
  if (phase_ == Phase::jumpSwitch || target.halvings >= options_->maxHalvings) {
    phase_ = Phase::failed;
    return;
  }
  // one that halves on and on would keep a whole set of lanes for itself
  constexpr int mostHalvedSteps = 16;
  if (target.halvings == 0 && ++recorder_.trajectory().halvedSteps > mostHalvedSteps) {
    phase_ = Phase::failed;
    return;
  }
  const Target half{t0_ + (target.time - t0_) / 2, ++target.halvings};
  targets_.push_back(half);
  returnToBegin();
}

void LaneDriver::accept(bool endsTarget) {
  const double h = t1_ - t0_;
  lastQ_.add(h, lengths_, q_, qEnd_);
  lastFibre_.add(h, lengths_, fibre_, fibreEnd_);
  lengths_.add(h);
  q_ = qEnd_;
  p_ = pEnd_;
  fibre_.swap(fibreEnd_);
  for (int i = 0; i < 3; ++i) sums_[i] += works_[i];
  t0_ = t1_;
  phase_ = Phase::wholeStep;
  if (!endsTarget) return;
  targets_.pop_back();
  if (!targets_.empty()) return;
  using Number = Eigen::Matrix<double, 1, 1>;
  recorder_.add(t1_, Number(q_), Number(p_ / mass_), activation_, fibre_, sums_[0], sums_[1],
                sums_[2]);
  ++recorder_.trajectory().steps;
  within_ = false;  // the course goes on; it differs by 2e-13 where the excitation changes
  if (++row_ < rows_) {
    targets_.push_back({stepping::rowTime(*options_, row_), 0});
  } else {
    phase_ = Phase::finished;
  }
}

template bool LaneDriver::ask(int, LaneStep<Lanes<4>>&);
template bool LaneDriver::ask(int, LaneStep<Lanes<8>>&);
template void LaneDriver::take(int, const LaneStep<Lanes<4>>&);
template void LaneDriver::take(int, const LaneStep<Lanes<8>>&);

}  // namespace bio::lanes
