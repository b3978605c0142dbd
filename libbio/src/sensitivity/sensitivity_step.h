#pragma once

// A step of the variational integrator, differentiated; not public.

#include "sensitivity/parameter_jacobian.h"
#include "sensitivity/step_tape.h"
#include "simulation/coordinate_sums.h"
#include "simulation/other_forces.h"

namespace bio::stepping {

/// Carries d(state)/dθ over a step r(z′, z, θ) = 0 by the implicit function theorem.
template <int N>
class SensitivityStep {
 public:
  using Index = Eigen::Index;
  using RowVector = Eigen::RowVectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using State = SensitivityState<N>;
  using Rows = typename State::Rows;

  SensitivityStep(const MusculoskeletalSystem& arm, const SimulationOptions& options,
                  SystemConfiguration<N>& configuration, DirectEffects<N>& direct, Index columns)
      : arm_(arm),
        options_(options),
        symmetric_(options.integrator == Integrator::variational),
        configuration_(configuration),
        others_(arm),
        direct_(direct),
        through_(arm.numMuscles()),
        pieces_(arm.numMuscles()) {
    forward_.setZero(countOf<N>(arm), columns);
    force_.setZero(countOf<N>(arm), columns);
    trialFibre_.setZero(static_cast<Index>(arm.numMuscles()), columns);
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
    const StepTape::Part& part = tape.parts()[i];
    const double t0 = tape.times()[part.begin].value, t1 = tape.times()[part.end].value;
    const double h = t1 - t0;
    const double tMiddle = t0 + h / 2;
    const double share = symmetric_ ? h / 2 : h;  // of the forces in F⁻
    const double endShare = symmetric_ ? share : 0;
    const Vector q0 = tape.q(i), q1 = tape.q(i + 1);
    const Vector q_m = (q0 + q1) / 2;
    const Vector v = (q1 - q0) / h;
    const auto l0 = tape.fibreLength(i), l1 = tape.fibreLength(i + 1);
    const auto activation = tape.middleActivation(i + 1);
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
    state.activation.advance({t0, dt0}, {tMiddle, timeMoves ? &middleTime_ : nullptr}, {t1, dt1},
                             tape.activation(i), activation);

    configuration_.moveTo(q_m);
    const int n = countOf<N>(arm_);
    // skeleton: (M v) and L_q = ½ vᵀ∂M v − ∂V over the middle configuration and the speed
    const EnergyDerivatives<N>& energy = configuration_.energy(v);
    Vector L_q = -energy.V_q;
    Matrix Mv_q = Matrix::Zero(n, n);
    Matrix L_qq = -energy.V_qq;
    Matrix L_qv = Matrix::Zero(n, n);
    if (!arm_.skeleton().hasConstantInertia()) {
      L_q += energy.T_q;
      Mv_q = energy.T_vq;
      L_qv = energy.T_vq.transpose();
      L_qq += energy.T_qq;
    }

    // passive coordinate forces
    Vector f = Vector::Zero(n);
    Matrix f_q = Matrix::Zero(n, n);
    Matrix f_v = Matrix::Zero(n, n);
    arm_.coordinateForces().template add<N>(q_m, v, f, f_q, f_v);
    force_.setZero();  // what of df does not go through dq′
    direct_.addPassiveForces(q_m, v, force_);
    if (!options_.externalForce.empty()) {
      const ExternalForce::At external = options_.externalForce.at(tMiddle);
      f += external.value;
      if (timeMoves) force_ += external.slope * middleTime_;
    }
    if (others_.any()) {
      others_.add(tMiddle, configuration_, v, f, f_q, f_v);
      f += others_.load();
      f_q += others_.load_q();
      if (timeMoves) force_ += others_.load_t() * middleTime_;
    }
    state.columns.addNodes(tMiddle, force_);

    // muscles: dℓ′ = trialFibre + (V_L/2J) ∂ℓ·dq′
    Matrix f_end = Matrix::Zero(n, n);  // df through the fibres that dq′ moves
    for (std::size_t m = 0; m < arm_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const SimulatedMuscle& muscle = arm_.muscles()[m].muscle;
      const LengthJet<N>& path = configuration_.length(m);
      if (!muscle.hasFibreState()) {
        addRigid(m, q_m, v, activation[sm], path, state, f, f_q, f_v);
        continue;
      }
      const double l_m = (l0[sm] + l1[sm]) / 2;
      const double l_v = (l1[sm] - l0[sm]) / h;
      const FibreRateDerivatives r =
          muscle.rateNear(activation[sm], l_m, path.length, l_v, h, pieces_[m]);
      const bool isHeld = muscle.isHeld(l1[sm]);
      const double perJ = isHeld ? 0 : 1 / (1 / h - r.dV_dFibreLength / 2);
      auto trial = trialFibre_.row(sm);
      const double half = r.dV_dMuscleTendonLength / 2 * perJ;
      setAlong(trial, ((1 / h + r.dV_dFibreLength / 2) * perJ) * state.fibre.row(sm), half, path,
               state.dq);
      state.activation.add(r.dV_dActivation * perJ, state.activation.middle(), sm, trial);
      if (timeMoves) trial += ((l1[sm] - l0[sm]) / (h * h) * perJ) * row_;
      addMuscleParameters(m, q_m, activation[sm], l_m, l_v, path, r, perJ, trial);
      if (isHeld) addShortest(m, trial);

      addAlong<N>(f, -r.tendonForce, path);
      addOuter<N>(f_q, -r.dF_dMuscleTendonLength, path);
      addSecond<N>(f_q, -r.tendonForce, path);
      const double G = r.dF_dFibreLength / 2;
      addOuter<N>(f_end, -(G * half), path);
      forEachMoved<N>(path, [&](int k, int) {
        force_.row(k) -= (G * path.dL_dq[k]) * (state.fibre.row(sm) + trial);
      });
    }

    // With q_mid = (q_begin + q_end)/2 and v = (q_end − q_begin)/h, the chain rule gives the
    // derivatives of any x(q_mid, v): x_end = x_q/2 + x_v/h, x_begin = x_q/2 − x_v/h, x_h = −x_v
    // v/h.
    const Matrix& M = energy.T_vv;
    const Matrix residual_q = Mv_q - h / 2 * L_qq - share * f_q;
    const Matrix residual_v = M - h / 2 * L_qv - share * f_v;
    const Matrix momentum_q = Mv_q + h / 2 * L_qq + endShare * f_q;
    const Matrix momentum_v = M + h / 2 * L_qv + endShare * f_v;
    direct_.computeInertia(v);

    // R: (∂R/∂q′ − …) dq′ = −(all the rest)
    const Matrix J = residual_q / 2 + residual_v / h - share * f_end;
    const Matrix perJ = inverseOf(J);
    const Matrix atBegin = residual_q / 2 - residual_v / h;
    forward_.noalias() = (-perJ * atBegin) * state.dq;
    forward_.noalias() += perJ * state.dp;
    forward_.noalias() += (share * perJ) * force_;
    if (direct_.changesInertia()) {
      forward_.noalias() -= perJ * direct_.momentum();
      forward_.noalias() += (h / 2 * perJ) * direct_.slope();
    }
    if (timeMoves) {
      const Vector inTime = -residual_v * v / h - L_q / 2 - share / h * f;
      forward_.noalias() -= (perJ * inTime) * row_;
      if (dt1 && !arm_.prescribed().empty()) addGiven(t1, *dt1);
    }

    // p′
    const Matrix endToEnd = momentum_q / 2 + momentum_v / h + endShare * f_end;
    const Matrix beginToEnd = momentum_q / 2 - momentum_v / h;
    state.dp.noalias() = endToEnd * forward_;
    state.dp.noalias() += beginToEnd * state.dq;
    if (direct_.changesInertia()) state.dp += direct_.momentum() + h / 2 * direct_.slope();
    if (symmetric_) state.dp += endShare * force_;
    if (timeMoves) {
      const Vector inTime = -momentum_v * v / h + L_q / 2 + endShare / h * f;
      state.dp.noalias() += inTime * row_;
    }

    // ℓ′ and q′
    for (std::size_t m = 0; m < arm_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const LengthJet<N>& path = configuration_.length(m);
      setAlong(state.fibre.row(sm), trialFibre_.row(sm), through_[m], path, forward_);
    }
    state.dq.swap(forward_);
  }

 private:
  /// J⁻¹ from residuals to dq′. Of prescribed coordinates dq′ is known: 0, or what a time that
  /// moves makes of it. Their residuals are not solved, their columns are 0, and givenColumns_
  /// carries their dq′ to all others.
  Matrix inverseOf(Matrix J) {
    if (arm_.prescribed().empty()) return J.inverse();
    for (const int k : arm_.prescribed()) {
      J.row(k).setZero();
      J(k, k) = 1;
    }
    givenColumns_ = J.inverse();
    Matrix perJ = givenColumns_;
    for (const int k : arm_.prescribed()) perJ.col(k).setZero();
    return perJ;
  }

  /// dq′ of prescribed coordinates at the end t1 of a step, which moves.
  void addGiven(double t1, const RowVector& dt1) {
    Vector q = Vector::Zero(countOf<N>(arm_)), speed = q;
    options_.prescribed.place(t1, q, speed);
    forward_.noalias() += Vector(givenColumns_ * speed) * dt1;
  }

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

  /// ∂r/∂θ of one muscle: into its fibre's row and into the force on the skeleton.
  template <class Row>
  void addMuscleParameters(std::size_t m, const Vector& q, double activation, double l_m,
                           double l_v, const LengthJet<N>& path, const FibreRateDerivatives& r,
                           double perJ, Row& trial) {
    through_[m] = r.dV_dMuscleTendonLength / 2 * perJ;
    const auto& effects = direct_.effects().muscles[m];
    if (!effects.fibre.empty()) {
      const SimulatedMuscle::InNumbers d =
          arm_.muscles()[m].muscle.inNumbers(activation, l_m, path.length, l_v);
      for (const QuantityEffect& effect : effects.fibre) {
        trial[effect.column] += effect.factor * perJ * d.dV[effect.quantity];
        force_.col(effect.column) -= effect.factor * d.dF[effect.quantity] * path.dL_dq;
      }
    }
    direct_.forGeometry(m, q, [&](const QuantityEffect& effect, const auto& gradient) {
      trial[effect.column] += effect.factor * r.dV_dMuscleTendonLength * perJ * gradient[0];
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
    const PerMuscleNumber d = arm_.muscles()[m].muscle.shortestInNumbers();
    for (const QuantityEffect& effect : effects.fibre) {
      trial[effect.column] += effect.factor * d[effect.quantity];
    }
  }

  /// The force of a muscle with a rigid tendon, which has no fibre to carry on, with what it adds
  /// to the derivatives over the middle configuration and the speed, and to df/dθ.
  void addRigid(std::size_t m, const Vector& q, const Vector& v, double activation,
                const LengthJet<N>& path, const State& state, Vector& f, Matrix& f_q, Matrix& f_v) {
    through_[m] = 0;
    const auto sm = static_cast<Index>(m);
    trialFibre_.row(sm).setZero();
    const SimulatedMuscle& muscle = arm_.muscles()[m].muscle;
    const double speed = path.dL_dq.dot(v);
    const muscles::RigidRate<double> r = muscle.rigidRate(activation, path.length, speed);
    addAlong<N>(f, -r.tendonForce, path);
    Vector F_q = r.dF_dPathLength * path.dL_dq;
    addSecondTimes<N>(F_q, r.dF_dPathSpeed, path, v);
    f_q.noalias() -= path.dL_dq * F_q.transpose();
    addSecond<N>(f_q, -r.tendonForce, path);
    addOuter<N>(f_v, -r.dF_dPathSpeed, path);
    forEachMoved<N>(path, [&](int k, int) {
      state.activation.add(-r.dF_dActivation * path.dL_dq[k], state.activation.middle(), sm,
                           force_.row(k));
    });
    const auto& effects = direct_.effects().muscles[m];
    if (!effects.fibre.empty()) {
      const PerMuscleNumber d = muscle.rigidInNumbers(activation, path.length, speed);
      for (const QuantityEffect& effect : effects.fibre) {
        force_.col(effect.column) -= effect.factor * d[effect.quantity] * path.dL_dq;
      }
    }
    direct_.forGeometry(m, q, [&](const QuantityEffect& effect, const auto& gradient) {
      double change = r.dF_dPathLength * gradient[0];
      forEachMoved<N>(
          path, [&](int k, int slot) { change += r.dF_dPathSpeed * gradient[1 + slot] * v[k]; });
      forEachMoved<N>(path, [&](int k, int slot) {
        force_(k, effect.column) -=
            effect.factor * (change * path.dL_dq[k] + r.tendonForce * gradient[1 + slot]);
      });
    });
  }

  const MusculoskeletalSystem& arm_;
  const SimulationOptions& options_;
  bool symmetric_;
  SystemConfiguration<N>& configuration_;
  OtherForces<N> others_;
  DirectEffects<N>& direct_;
  Matrix givenColumns_;                ///< used where a coordinate is prescribed
  std::vector<double> through_;        ///< (V_L/2J) of each muscle
  std::vector<SchuttePieces> pieces_;  ///< of each muscle's last state
  Rows forward_;                       ///< dq′/dθ
  Rows force_;                         ///< df/dθ but through dq′
  SensitivityMatrix trialFibre_;       ///< dℓ′/dθ but through dq′
  RowVector row_, middleTime_;         ///< dh/dθ and that of the step's middle
};

}  // namespace bio::stepping
