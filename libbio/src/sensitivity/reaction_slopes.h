#pragma once

// Sensitivities of the reactions at prescribed coordinates; not public.

#include "sensitivity/parameter_jacobian.h"
#include "simulation/coordinate_sums.h"
#include "simulation/system_dynamics.h"

namespace bio::stepping {

/// dR/dθ of the reactions R at one row of a motion. With τ(q, q̇, F, θ) all that is in
/// M q̈ = τ + R at given accelerations, less ∂(M q̈), and X_f = M_ff⁻¹ dτ_f, X_p = 0,
///     dR = M X − dτ
template <int N>
class ReactionSlopes {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using Rows = typename SensitivityState<N>::Rows;

  /// @param configuration  shared with the caller, who moves it to the row's coordinates
  ReactionSlopes(const MusculoskeletalSystem& system, const SimulationOptions& simulation,
                 const ExcitationSignal& driven, SystemConfiguration<N>& configuration,
                 DirectEffects<N>& direct)
      : system_(system),
        dynamics_(system, driven, simulation.externalForce, simulation.prescribed),
        configuration_(configuration),
        direct_(direct),
        external_(simulation.externalForce),
        y_(dynamics_.size()),
        yDot_(dynamics_.size()) {}

  /// Into result.reaction, from the row of the motion. Moves the configuration.
  /// @param speed  dq̇/dθ
  /// @param forces  dF/dθ of the tendons
  void add(Index row, const SensitivityState<N>& state, const Rows& speed,
           const SensitivityMatrix& forces, SensitivityTrajectory& result) {
    const Trajectory& motion = result.motion;
    const Vector q = motion.q.col(row), qDot = motion.qDot.col(row);
    y_ << q, qDot, motion.activation.col(row), motion.fibreLength.col(row);
    dynamics_.derivative(motion.time[static_cast<std::size_t>(row)], y_, yDot_);
    Matrix tau_q = dynamics_.tau_q(), tau_v = dynamics_.tau_v();
    dynamics_.addInertia(tau_q, tau_v);
    tau_.noalias() = tau_q * state.dq;
    tau_.noalias() += tau_v * speed;
    direct_.addOtherForces(motion.time[static_cast<std::size_t>(row)], q, qDot, external_, tau_);
    state.columns.addExternal(motion.time[static_cast<std::size_t>(row)], tau_);
    for (std::size_t i = 0; i < system_.numMuscles(); ++i) {
      addMuscle(i, q, forces.row(static_cast<Index>(i)), state);
    }
    addInertia(q, qDot);
    Rows X = tau_;
    for (const int k : system_.prescribed()) X.row(k).setZero();
    X = dynamics_.factor().solve(X).eval();
    tau_ = dynamics_.massMatrix() * X - tau_;
    for (const int k : system_.prescribed()) {
      state.columns.record(tau_.row(k), result.reaction[static_cast<std::size_t>(k)].row(row));
    }
  }

 private:
  /// d(−F ∂ℓ)
  template <class Force>
  void addMuscle(std::size_t i, const Vector& q, const Force& force,
                 const SensitivityState<N>& state) {
    const LengthJet<N>& path = configuration_.length(i);
    const double F = dynamics_.rate(i).tendonForce;
    forEachMoved<N>(path, [&](int k, int slot) {
      tau_.row(k) -= path.dL_dq[k] * force;
      forEachMoved<N>(path, [&](int j, int other) {
        tau_.row(k) -= (F * secondOf(path, slot, other)) * state.dq.row(j);
      });
    });
    direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
      forEachMoved<N>(path, [&](int k, int slot) {
        tau_(k, effect.column) -= effect.factor * F * gradient[1 + slot];
      });
    });
  }

  static double secondOf(const LengthJet<N>& path, int slot, int other) {
    if constexpr (N == Eigen::Dynamic) {
      return path.second(slot, other);
    } else {
      return path.d2L_dq2(slot, other);
    }
  }

  /// ∂/∂θ of −M q̈ − Ṁ q̇ + ½ q̇ᵀ∂M q̇ − ∂V; the rate of the momentum by central differences.
  void addInertia(const Vector& q, const Vector& qDot) {
    if (!direct_.changesInertia()) return;
    direct_.computeInertia(dynamics_.acceleration());
    tau_ -= direct_.momentum();
    direct_.computeInertia(qDot);
    tau_ += direct_.slope();
    const double speed = qDot.cwiseAbs().maxCoeff();
    if (system_.skeleton().hasConstantInertia() || speed == 0) return;
    // a way δ of 1e-5 rad or m: δ²/6 = 2e-11 of truncation, and rounding of about 1e-16/δ = 1e-11
    const double dt = 1e-5 / speed;
    configuration_.moveSkeletonTo(q + dt * qDot);
    direct_.computeInertia(qDot);
    tau_ -= direct_.momentum() / (2 * dt);
    configuration_.moveSkeletonTo(q - dt * qDot);
    direct_.computeInertia(qDot);
    tau_ += direct_.momentum() / (2 * dt);
  }

  const MusculoskeletalSystem& system_;
  SystemDynamics<N> dynamics_;
  SystemConfiguration<N>& configuration_;
  DirectEffects<N>& direct_;
  const ExternalForce& external_;
  Eigen::VectorXd y_, yDot_;
  Rows tau_;
};

}  // namespace bio::stepping
