#pragma once

// A step of the variational integrator, differentiated; not public.

#include "sensitivity/linearised_step.h"
#include "sensitivity/parameter_jacobian.h"

namespace bio::stepping {

/// Carries d(state)/dθ over a step r(z′, z, θ) = 0 by the implicit function theorem.
template <int N>
class SensitivityStep {
 public:
  using Index = Eigen::Index;
  using RowVector = Eigen::RowVectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;
  using State = SensitivityState<N>;
  using Rows = typename State::Rows;

  SensitivityStep(const MusculoskeletalSystem& system, const SimulationOptions& options,
                  SystemConfiguration<N>& configuration, DirectEffects<N>& direct, Index columns)
      : system_(system),
        options_(options),
        configuration_(configuration),
        direct_(direct),
        step_(system, options, configuration) {
    forward_.setZero(countOf<N>(system), columns);
    force_.setZero(countOf<N>(system), columns);
    trialFibre_.setZero(static_cast<Index>(system.numMuscles()), columns);
    row_.setZero(columns);
  }

  void widen(const SensitivityColumns& columns) {
    for (Rows* rows : {&forward_, &force_}) columns.widen(*rows);
    columns.widen(trialFibre_);
    for (RowVector* row : {&row_, &middleTime_}) columns.widen(*row);
  }

  /// Part i of the tape, from a time to a time with their derivatives; null: fixed.
  void advance(const StepTape& tape, std::size_t i, const RowVector* dt0, const RowVector* dt1,
               State& state) {
    step_.moveTo(tape, i);
    const double h = step_.h();
    const bool timeMoves = dt0 || dt1;
    if (timeMoves) {
      state.activation.spread(state.columns);
      row_.setZero();
      if (dt1) row_ += *dt1;
      if (dt0) row_ -= *dt0;  // dh
      middleTime_ = row_ / 2;
      if (dt0) middleTime_ += *dt0;
    }

    // activations at the middle and at the end
    state.activation.advance({step_.begin(), dt0},
                             {step_.middle(), timeMoves ? &middleTime_ : nullptr},
                             {step_.end(), dt1}, tape.activation(i), tape.middleActivation(i + 1));

    // what of df does not go through dq′
    force_.setZero();
    direct_.addOtherForces(step_.middle(), step_.q_m(), step_.v(), options_.externalForce, force_);
    if (timeMoves && !options_.externalForce.empty()) {
      force_ += step_.externalSlope() * middleTime_;
    }
    if (timeMoves && step_.others().any()) force_ += step_.others().load_t() * middleTime_;
    state.columns.addExternal(step_.middle(), force_);

    // muscles: dℓ′ = trialFibre + (V_L/2J) ∂ℓ·dq′
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      if (step_.muscle(m).hasFibre) {
        addElastic(m, timeMoves, state);
      } else {
        addRigid(m, state);
      }
    }
    direct_.computeInertia(step_.v());

    // R: (∂R/∂q′ − …) dq′ = −(all the rest)
    const auto& perJ = step_.perJ();
    forward_.noalias() = (-perJ * step_.residualAtBegin()) * state.dq;
    forward_.noalias() += perJ * state.dp;
    forward_.noalias() += (step_.share() * perJ) * force_;
    if (direct_.changesInertia()) {
      forward_.noalias() -= perJ * direct_.momentum();
      forward_.noalias() += (h / 2 * perJ) * direct_.slope();
    }
    if (timeMoves) {
      forward_.noalias() -= (perJ * step_.residualInLength()) * row_;
      if (dt1 && !system_.prescribed().empty()) {
        forward_.noalias() += Vector(step_.givenColumns() * step_.givenSpeeds()) * *dt1;
      }
    }

    // p′
    state.dp.noalias() = step_.momentumAtEnd() * forward_;
    state.dp.noalias() += step_.momentumAtBegin() * state.dq;
    if (direct_.changesInertia()) state.dp += direct_.momentum() + h / 2 * direct_.slope();
    if (step_.isSymmetric()) state.dp += step_.endShare() * force_;
    if (timeMoves) state.dp.noalias() += step_.momentumInLength() * row_;

    // ℓ′ and q′
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const LengthJet<N>& path = configuration_.length(m);
      setAlong(state.fibre.row(sm), trialFibre_.row(sm), step_.muscle(m).half, path, forward_);
    }
    state.dq.swap(forward_);
  }

 private:
  /// row = base + factor Σ_k ∂_kℓ rows_k, in one pass for one coordinate
  template <class Row, class Base, class Rows>
  static void setAlong(Row&& row, const Base& base, double factor, const LengthJet<N>& path,
                       const Rows& rows) {
    if constexpr (N == Eigen::Dynamic) {
      row = base;
      for (const int k : path.support) row += (factor * path.dL_dq[k]) * rows.row(k);
    } else {
      row = base + (factor * path.dL_dq[0]) * rows.row(0);
      for (int k = 1; k < N; ++k) row += (factor * path.dL_dq[k]) * rows.row(k);
    }
  }

  /// A muscle with a fibre: the fibre's row, and what of the force goes through it.
  void addElastic(std::size_t m, bool timeMoves, const State& state) {
    const auto sm = static_cast<Index>(m);
    const auto& here = step_.muscle(m);
    const FibreRateDerivatives& r = here.r;
    const LengthJet<N>& path = configuration_.length(m);
    const double h = step_.h();
    auto trial = trialFibre_.row(sm);
    setAlong(trial, ((1 / h + r.dV_dFibreLength / 2) * here.perJ) * state.fibre.row(sm), here.half,
             path, state.dq);
    state.activation.add(r.dV_dActivation * here.perJ, state.activation.middle(), sm, trial);
    if (timeMoves) trial += (here.stretch / (h * h) * here.perJ) * row_;
    addMuscleParameters(m, trial);
    if (here.isHeld) addShortest(m, trial);
    const double G = r.dF_dFibreLength / 2;
    forEachMoved<N>(path, [&](int k, int) {
      force_.row(k) -= (G * path.dL_dq[k]) * (state.fibre.row(sm) + trial);
    });
  }

  /// ∂r/∂θ of one muscle: into its fibre's row and into the force on the skeleton.
  template <class Row>
  void addMuscleParameters(std::size_t m, Row& trial) {
    const auto& here = step_.muscle(m);
    const FibreRateDerivatives& r = here.r;
    const LengthJet<N>& path = configuration_.length(m);
    const auto& effects = direct_.effects().muscles[m];
    if (!effects.fibre.empty()) {
      const SimulatedMuscle::InNumbers d = system_.muscles()[m].muscle.inNumbers(
          here.activation, here.l_m, path.length, here.l_v, step_.pieces(m));
      for (const QuantityEffect& effect : effects.fibre) {
        trial[effect.column] += effect.factor * here.perJ * d.dV[effect.quantity];
        force_.col(effect.column) -= effect.factor * d.dF[effect.quantity] * path.dL_dq;
      }
    }
    direct_.forGeometry(m, step_.q_m(), [&](const QuantityEffect& effect, const auto& gradient) {
      trial[effect.column] += effect.factor * r.dV_dMuscleTendonLength * here.perJ * gradient[0];
      forEachMoved<N>(path, [&](int k, int slot) {
        force_(k, effect.column) -=
            effect.factor * (r.dF_dMuscleTendonLength * gradient[0] * path.dL_dq[k] +
                             r.tendonForce * gradient[1 + slot]);
      });
    });
  }

  /// ∂ℓ′/∂θ of a fibre that is held.
  template <class Row>
  void addShortest(std::size_t m, Row& trial) {
    const auto& effects = direct_.effects().muscles[m];
    if (effects.fibre.empty()) return;
    const PerMuscleNumber d = system_.muscles()[m].muscle.shortestInNumbers();
    for (const QuantityEffect& effect : effects.fibre) {
      trial[effect.column] += effect.factor * d[effect.quantity];
    }
  }

  /// The part of the force of a muscle with a rigid tendon that does not go through dq′; it has no
  /// fibre to carry on.
  void addRigid(std::size_t m, const State& state) {
    const auto sm = static_cast<Index>(m);
    trialFibre_.row(sm).setZero();
    const auto& here = step_.muscle(m);
    const muscles::RigidRate<double>& r = here.rigid;
    const LengthJet<N>& path = configuration_.length(m);
    const Vector& v = step_.v();
    forEachMoved<N>(path, [&](int k, int) {
      state.activation.add(-r.dF_dActivation * path.dL_dq[k], state.activation.middle(), sm,
                           force_.row(k));
    });
    const auto& effects = direct_.effects().muscles[m];
    if (!effects.fibre.empty()) {
      const PerMuscleNumber d =
          system_.muscles()[m].muscle.rigidInNumbers(here.activation, path.length, here.speed);
      for (const QuantityEffect& effect : effects.fibre) {
        force_.col(effect.column) -= effect.factor * d[effect.quantity] * path.dL_dq;
      }
    }
    direct_.forGeometry(m, step_.q_m(), [&](const QuantityEffect& effect, const auto& gradient) {
      double change = r.dF_dPathLength * gradient[0];
      forEachMoved<N>(
          path, [&](int k, int slot) { change += r.dF_dPathSpeed * gradient[1 + slot] * v[k]; });
      forEachMoved<N>(path, [&](int k, int slot) {
        force_(k, effect.column) -=
            effect.factor * (change * path.dL_dq[k] + r.tendonForce * gradient[1 + slot]);
      });
    });
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  SystemConfiguration<N>& configuration_;
  DirectEffects<N>& direct_;
  LinearisedStep<N> step_;
  Rows forward_;                  ///< dq′/dθ
  Rows force_;                    ///< df/dθ but through dq′
  SensitivityMatrix trialFibre_;  ///< dℓ′/dθ but through dq′
  RowVector row_, middleTime_;    ///< dh/dθ and that of the step's middle
};

}  // namespace bio::stepping
