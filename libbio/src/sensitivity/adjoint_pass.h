#pragma once

// The pass back along the tape of a run that collects a cost's gradient; not public.

#include "bio/sensitivity/cost_gradient.h"
#include "sensitivity/adjoint_step.h"
#include "sensitivity/excitation_sensitivity.h"

namespace bio::stepping {

/// Carries dJ/d(state) back along the tape.
template <int N>
class AdjointPass {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  AdjointPass(const MusculoskeletalSystem& system, const ParameterEffects& effects,
              const ParameterCatalogue::Setting& setting, const ExcitationSignal& driven,
              Index numParameters, const SimulationOptions& options)
      : system_(system),
        options_(options),
        configuration_(system),
        direct_(system, effects, setting.model, configuration_, 1),
        sums_(system, direct_, configuration_, numParameters),
        excitation_(system, driven),
        step_(system, options, configuration_, sums_, excitation_),
        state_(system),
        trial_(system) {}

  /// @param slopes  of the cost at the rows of result.motion, which is filled in
  void run(const SystemState& start, const StepTape& tape, const ExcitationSignal& trial,
           const EmgMapping& mapping, const CostOfMotion& slopes, CostGradient& result) {
    inTimes_.assign(tape.times().size(), 0.0);
    Index row = 0;
    for (const StepTape::Part& part : tape.parts()) row += part.endsRow ? 1 : 0;
    for (std::size_t i = tape.parts().size(); i-- > 0;) {
      if (tape.parts()[i].endsRow) addRow(row--, result.motion, slopes);
      follow(tape, i);
    }
    addRow(0, result.motion, slopes);
    finish(start, result.motion.time.front(), result);
    const ParameterEffects& effects = direct_.effects();
    addActivations(excitationRows(system_, effects, trial, mapping), result.gradient);
    for (const auto& effect : effects.start) {
      result.gradient[effect.column] +=
          effect.weight *
          (effect.isSpeed ? result.startSpeed : result.startCoordinate)[effect.coordinate];
    }
    result.excitation = excitation_.excitation();
  }

 private:
  /// Direct slopes of the cost in a row: q, and q̇ = M⁻¹p.
  void addRow(Index row, const Trajectory& motion, const CostOfMotion& slopes) {
    if (row >= motion.q.cols()) return;
    state_.q += slopes.q.col(row);
    Vector inSpeed = slopes.qDot.col(row);
    for (const int k : system_.prescribed()) inSpeed[k] = 0;
    if (inSpeed.isZero(0)) return;
    const Vector qDot = motion.qDot.col(row);
    configuration_.moveSkeletonTo(motion.q.col(row));
    const EnergyDerivatives<N>& energy = configuration_.energy(qDot);
    Matrix M = energy.T_vv;
    decouple(system_.prescribed(), M);
    Vector s = M.ldlt().solve(inSpeed);
    for (const int k : system_.prescribed()) s[k] = 0;
    state_.p += s;
    if (!system_.skeleton().hasConstantInertia()) state_.q -= energy.T_vq.transpose() * s;
    sums_.addInertia(qDot, -s, Vector::Zero(s.size()));
  }

  /// Back over one part of a step.
  void follow(const StepTape& tape, std::size_t i) {
    const StepTape::Part& part = tape.parts()[i];
    const StepTape::Time& end = tape.times()[part.end];
    step_.moveTo(tape, i);
    if (end.law == StepTape::Time::Law::onSwitch) holdSwitch(end, inTimes_[part.end]);
    const auto times = step_.pullBack(state_, true);
    addToTime(tape, part.begin, times.begin);
    if (end.law == StepTape::Time::Law::middle) addToTime(tape, part.end, times.end);
  }

  /// dJ at a held time of a switch from that with the time t that moves: with x the state,
  /// dt = −dq_k/(∂q_k/∂t) makes of it λ − e_k (λ·∂x/∂t + dJ/dt)/(∂q_k/∂t).
  void holdSwitch(const StepTape::Time& end, double inTime) {
    const int k = end.met->freeIndex;
    trial_ = state_;
    const double along = step_.pullBack(trial_, false).end + inTime;
    trial_.setZero();
    trial_.q[k] = 1;
    state_.q[k] -= along / step_.pullBack(trial_, false).end;
  }

  /// A middle follows both its ends; rows are fixed.
  void addToTime(const StepTape& tape, std::size_t index, double slope) {
    const StepTape::Time& time = tape.times()[index];
    if (time.law == StepTape::Time::Law::onSwitch) inTimes_[index] += slope;
    if (time.law != StepTape::Time::Law::middle) return;
    addToTime(tape, time.first, slope / 2);
    addToTime(tape, time.second, slope / 2);
  }

  /// Through the start: p = M q̇, and fibres that rest.
  void finish(const SystemState& start, double time, CostGradient& result) {
    const Vector q = start.q;
    Vector qDot = start.qDot;
    if (!system_.prescribed().empty()) {
      Vector placed = q;
      options_.prescribed.place(time, placed, qDot);
    }
    configuration_.moveTo(q);
    const EnergyDerivatives<N>& energy = configuration_.energy(qDot);
    result.startSpeed = energy.T_vv.transpose() * state_.p;
    state_.q += energy.T_vq.transpose() * state_.p;
    sums_.addInertia(qDot, state_.p, Vector::Zero(q.size()));
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const SimulatedMuscle& muscle = system_.muscles()[m].muscle;
      if (!muscle.hasFibreState()) continue;
      const LengthJet<N>& path = configuration_.length(m);
      const SimulatedMuscle::RestSlopes d = muscle.restSlopes(
          start.activation[sm], path.length, muscle.rest(start.activation[sm], path.length));
      const double lambda = state_.fibre[sm];
      addAlong<N>(state_.q, lambda * d.dl_dPathLength, path);
      state_.activation[sm] += lambda * d.dl_dActivation;
      sums_.addNumbers(m, lambda, d.dl_dNumber);
      if (!sums_.hasGeometry(m)) continue;
      Eigen::Matrix<double, N == Eigen::Dynamic ? N : N + 1, 1> w;
      if constexpr (N == Eigen::Dynamic) w.resize(1 + static_cast<Index>(path.support.size()));
      w.setZero();
      w[0] = lambda * d.dl_dPathLength;
      sums_.addGeometry(m, q, w);
    }
    result.startCoordinate = state_.q;
    for (const int k : system_.prescribed()) result.startCoordinate[k] = result.startSpeed[k] = 0;
    excitation_.finish(time, state_.activation);
    result.gradient = sums_.inColumns();
  }

  /// Gradient through activations: by their dynamics, the delay and the EMG's mapping.
  void addActivations(const std::vector<std::vector<RowsOfColumn>>& emg,
                      Eigen::VectorXd& gradient) const {
    const ParameterEffects& effects = direct_.effects();
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      for (const QuantityEffect& effect : effects.muscles[m].activation) {
        gradient[effect.column] +=
            effect.factor * excitation_.numbers()(static_cast<Index>(effect.quantity), sm);
      }
      for (const RowsOfColumn& column : emg[m]) {
        gradient[column.column] += column.rows.dot(excitation_.excitation().row(sm));
      }
    }
    for (const QuantityEffect& effect : effects.delay) {
      gradient[effect.column] += effect.factor * excitation_.delay();
    }
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  SystemConfiguration<N> configuration_;
  DirectEffects<N> direct_;
  GradientSums<N> sums_;
  ExcitationAdjoint excitation_;
  AdjointStep<N> step_;
  AdjointState<N> state_, trial_;
  std::vector<double> inTimes_;  ///< dJ in the times of switches
};

}  // namespace bio::stepping
