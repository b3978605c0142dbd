#pragma once

// The pass along the tape of a run that carries its sensitivities; not public.

#include <cmath>

#include "sensitivity/sensitivity_recorder.h"
#include "sensitivity/sensitivity_step.h"
#include "sensitivity/tape_slopes.h"

namespace bio::stepping {

/// Carries d(state)/dθ along the tape.
template <int N>
class SensitivityPass {
 public:
  using Index = Eigen::Index;
  using RowVector = Eigen::RowVectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;

  SensitivityPass(const MusculoskeletalSystem& system, const ParameterEffects& effects,
                  const ParameterCatalogue::Setting& setting, const ExcitationSignal& trial,
                  const ExcitationSignal& driven, Index numParameters,
                  const SensitivityOptions& options)
      : system_(system),
        options_(options),
        driven_(driven),
        configuration_(system),
        state_{SensitivityColumns(numParameters, options),
               {},
               {},
               {},
               ActivationColumns({system, effects, trial, driven, setting.mapping},
                                 static_cast<Index>(system.numMuscles()))},
        direct_(system, effects, setting.model, configuration_, state_.columns.count()),
        step_(system, options.simulation, configuration_, direct_, state_.columns.count()) {
    const Index columns = state_.columns.count();
    state_.dq.setZero(countOf<N>(system), columns);
    state_.dp.setZero(countOf<N>(system), columns);
    state_.fibre.setZero(static_cast<Index>(system.numMuscles()), columns);
    unit_.setZero(columns);
    unit_[state_.columns.ofTime()] = 1;
  }

  SensitivityTrajectory run(Trajectory motion, const SystemState& start, const StepTape& tape) {
    const StopWatch watch;
    SensitivityTrajectory result;
    result.motion = std::move(motion);
    SensitivityRecorder<N> recorder(system_, options_, driven_, configuration_, direct_,
                                    state_.columns, result);
    const double first = result.motion.time.front();
    begin(start, first);
    // a reaction follows a force at once
    if (options_.reactions && state_.columns.beginNodes(std::nextafter(first, HUGE_VAL))) widen();
    recorder.add(state_);
    TapeSlopes slopes(tape);
    for (std::size_t i = 0; i < tape.parts().size(); ++i) {
      follow(tape, i, slopes);
      if (tape.parts()[i].endsRow) recorder.add(state_);
    }
    result.wallSeconds = watch.seconds();
    return result;
  }

 private:
  /// The start: p = M q̇, and the fibres rest, so that ℓ follows activation, ℓ_MT and the muscle's
  /// own parameters.
  void begin(const SystemState& start, double time) {
    const Vector q = start.q;
    Vector qDot = start.qDot;
    if (!system_.prescribed().empty()) {
      Vector placed = q;
      options_.simulation.prescribed.place(time, placed, qDot);
    }
    configuration_.moveTo(q);
    const EnergyDerivatives<N>& energy = configuration_.energy(qDot);
    auto& [columns, dq, dp, fibres, activation] = state_;
    for (const auto& effect : direct_.effects().start) {
      if (effect.isSpeed) {
        dp.col(effect.column) += effect.weight * energy.T_vv.col(effect.coordinate);
      } else {
        dq(effect.coordinate, effect.column) += effect.weight;
      }
    }
    direct_.computeInertia(qDot);
    dp += direct_.momentum();
    for (Index k = 0; k < dq.rows(); ++k) dp += energy.T_vq.col(k) * dq.row(k);
    activation.start(time);
    for (std::size_t i = 0; i < system_.numMuscles(); ++i) {
      const auto si = static_cast<Index>(i);
      const SimulatedMuscle& muscle = system_.muscles()[i].muscle;
      const LengthJet<N>& path = configuration_.length(i);
      const StaticEquilibrium rest = muscle.rest(start.activation[si], path.length);
      const SimulatedMuscle::RestSlopes d =
          muscle.restSlopes(start.activation[si], path.length, rest);
      auto fibre = fibres.row(si);
      fibre = d.dl_dPathLength * (path.dL_dq.transpose() * dq);
      activation.add(d.dl_dActivation, activation.end(), si, fibre);
      for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
        fibre[effect.column] += effect.factor * d.dl_dNumber[effect.quantity];
      }
      direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
        fibre[effect.column] += effect.factor * d.dl_dPathLength * gradient[0];
      });
    }
  }

  /// One part of a step.
  void follow(const StepTape& tape, std::size_t i, TapeSlopes& slopes) {
    const StepTape::Part& part = tape.parts()[i];
    const StepTape::Time& end = tape.times()[part.end];
    if (state_.columns.beginNodes(end.value)) widen();
    const RowVector* dt0 = slopes.of(part.begin, state_.columns);
    const bool meets = end.law == StepTape::Time::Law::onSwitch;
    const RowVector* dt1 = meets ? &unit_ : slopes.of(part.end, state_.columns);
    step_.advance(tape, i, dt0, dt1, state_);
    if (!meets) return;
    // dt/dθ = −(dq/dθ)/(dq/dt): the coordinate has its value at the switch whatever θ is
    const Index last = state_.columns.ofTime();
    const int k = end.met->freeIndex;
    RowVector& dt = slopes.found(part.end);
    dt = state_.dq.row(k) * (-1 / state_.dq(k, last));
    dt[last] = 0;
    state_.moveAlong(dt);
  }

  /// Every row gets the columns that there are by now.
  void widen() {
    state_.widen();
    direct_.widen(state_.columns);
    step_.widen(state_.columns);
    state_.columns.widen(unit_);
  }

  const MusculoskeletalSystem& system_;
  const SensitivityOptions& options_;
  const ExcitationSignal& driven_;
  SystemConfiguration<N> configuration_;
  SensitivityState<N> state_;
  DirectEffects<N> direct_;
  SensitivityStep<N> step_;
  RowVector unit_;  ///< 1 in the column of the time of a switch
};

}  // namespace bio::stepping
