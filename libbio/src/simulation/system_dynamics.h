#pragma once

// First-order form of the coupled equations, for the explicit and the adaptive integrator.

#include "simulation/integrators.h"

namespace bio::stepping {

inline const ExternalForce noExternalForce;

/// ẏ = f(t, y) with y = (q, q̇, activations, fibre lengths):
///     M q̈ = −Σ F_i ∂ℓ_i + τ_passive + τ_external − Ṁ q̇ + ½ q̇ᵀ∂M q̇ − ∂V,   ȧ = activation law,   ℓ̇
///     = V
template <int N>
class SystemDynamics {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using State = Eigen::VectorXd;

  SystemDynamics(const MusculoskeletalSystem& arm, const ExcitationSignal& excitation,
                 const ExternalForce& external = noExternalForce)
      : arm_(arm),
        excitation_(excitation),
        externalForce_(external),
        configuration_(arm),
        numMuscles_(static_cast<Eigen::Index>(arm.numMuscles())),
        u_(State::Zero(numMuscles_)),
        rate_(arm.numMuscles()),
        rigid_(arm.numMuscles()),
        pieces_(arm.numMuscles()) {}

  Eigen::Index size() const { return 2 * N + 2 * numMuscles_; }

  State pack(const SystemState& state) const {
    State y(size());
    y << state.q, state.qDot, state.activation, state.fibreLength;
    return y;
  }

  /// SystemConfiguration::holdConditions
  void holdConditions(const Vector& at) { configuration_.holdConditions(at); }

  struct Power {
    double muscle = 0;    ///< of the muscles on the skeleton [W]
    double passive = 0;   ///< of the coordinate forces [W]
    double external = 0;  ///< of what pushes from outside [W]
  };

  /// f(t, y) into yDot; returns the powers. NaN where a fibre has left its domain.
  template <class Y, class YDot>
  Power derivative(double t, const Y& y, YDot&& yDot) {
    evaluate(t, y);
    yDot.template head<N>() = qDot_;
    yDot.template segment<N>(N) = acceleration_;
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      yDot[2 * N + i] = arm_.muscles()[si].activation.rate(u_[i], y[2 * N + i]);
      yDot[2 * N + numMuscles_ + i] = rate_[si].fibreVelocity;
    }
    return {muscle_.dot(qDot_), passive_.dot(qDot_), external_.dot(qDot_)};
  }

  /// ∂f/∂y, dense; size() × size().
  template <class Y, class J>
  void jacobian(double t, const Y& y, J&& jacobian) {
    evaluate(t, y);
    const InertiaJet<N>& inertia = configuration_.inertia();
    jacobian.setZero();
    jacobian.template block<N, N>(0, N).setIdentity();
    Matrix dForce_dq = tau_q_ - inertia.d2V;
    Matrix dForce_dqDot = tau_v_;
    if (!arm_.skeleton().hasConstantInertia()) {
      for (int k = 0; k < N; ++k) {
        const auto sk = static_cast<std::size_t>(k);
        for (int j = 0; j < N; ++j) {
          const auto sj = static_cast<std::size_t>(j);
          const Matrix& M_kj = inertia.d2M[static_cast<std::size_t>(pairIndex(k, j))];
          // ∂/∂q_k of ½ q̇ᵀM_j q̇ in row j, and of −Ṁ q̇ = −Σ_j q̇_j M_j q̇
          dForce_dq(j, k) += qDot_.dot(M_kj * qDot_) / 2;
          dForce_dq.col(k) -= qDot_[j] * (M_kj * qDot_);
          dForce_dqDot(j, k) += inertia.dM[sj].row(k).dot(qDot_);
          dForce_dqDot.col(k) -= qDot_[j] * inertia.dM[sj].col(k);
        }
        dForce_dqDot.col(k) -= inertia.dM[sk] * qDot_;
        dForce_dq.col(k) -= inertia.dM[sk] * acceleration_;
      }
    }
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      const FibreRateDerivatives& r = rate_[si];
      const LengthJet<N>& path = configuration_.length(si);
      const auto& law = arm_.muscles()[si].activation;
      jacobian(2 * N + i, 2 * N + i) = law.rateSlope(u_[i], y[2 * N + i]);
      if (!arm_.muscles()[si].muscle.hasFibreState()) {
        const muscles::RigidRate<double>& rigid = rigid_[si];
        const Vector F_q =
            rigid.dF_dPathLength * path.dL_dq + rigid.dF_dPathSpeed * (path.d2L_dq2 * qDot_);
        dForce_dq -= path.dL_dq * F_q.transpose() + rigid.tendonForce * path.d2L_dq2;
        dForce_dqDot -= rigid.dF_dPathSpeed * path.dL_dq * path.dL_dq.transpose();
        if (!law.isDirect()) {
          jacobian.template block<N, 1>(N, 2 * N + i) =
              -factor_.solve(Vector(rigid.dF_dActivation * path.dL_dq));
        }
        continue;
      }
      dForce_dq -= r.dF_dMuscleTendonLength * path.dL_dq * path.dL_dq.transpose() +
                   r.tendonForce * path.d2L_dq2;
      const Eigen::Index a = 2 * N + i;
      const Eigen::Index l = a + numMuscles_;
      jacobian.template block<N, 1>(N, l) = -factor_.solve(Vector(r.dF_dFibreLength * path.dL_dq));
      jacobian.template block<1, N>(l, 0) = r.dV_dMuscleTendonLength * path.dL_dq.transpose();
      if (!law.isDirect()) jacobian(l, a) = r.dV_dActivation;
      jacobian(l, l) = r.dV_dFibreLength;
    }
    jacobian.template block<N, N>(N, 0) = factor_.solve(dForce_dq);
    jacobian.template block<N, N>(N, N) = factor_.solve(dForce_dqDot);
  }

  /// Of the last state that was evaluated.
  const FibreRateDerivatives& rate(std::size_t muscle) const { return rate_[muscle]; }

 private:
  template <class Y>
  void evaluate(double t, const Y& y) {
    const Vector q = y.template head<N>();
    qDot_ = y.template segment<N>(N);
    excitation_.at(t, hint_, u_);
    configuration_.moveTo(q);
    const InertiaJet<N>& inertia = configuration_.inertia();
    passive_.setZero();
    tau_q_.setZero();
    tau_v_.setZero();
    arm_.coordinateForces().template add<N>(q, qDot_, passive_, tau_q_, tau_v_);
    external_.setZero();
    externalForce_.add(t, externalRow_, external_);
    muscle_.setZero();
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      const SystemMuscle& muscle = arm_.muscles()[si];
      const LengthJet<N>& path = configuration_.length(si);
      const double activation = muscle.activation.acting(u_[i], y[2 * N + i]);
      if (muscle.muscle.hasFibreState()) {
        rate_[si] =
            muscle.muscle.rate(activation, y[2 * N + numMuscles_ + i], path.length, pieces_[si]);
      } else {
        rigid_[si] = muscle.muscle.rigidRate(activation, path.length, path.dL_dq.dot(qDot_));
        rate_[si] = {};
        rate_[si].tendonForce = rigid_[si].tendonForce;
      }
      muscle_ -= rate_[si].tendonForce * path.dL_dq;
    }
    Vector force = muscle_ + passive_ + external_ - inertia.dV;
    if (!arm_.skeleton().hasConstantInertia()) {
      for (int k = 0; k < N; ++k) {
        const Vector M_k_v = inertia.dM[static_cast<std::size_t>(k)] * qDot_;
        force[k] += qDot_.dot(M_k_v) / 2;
        force -= qDot_[k] * M_k_v;
      }
    }
    factor_.compute(inertia.massMatrix);
    acceleration_ = factor_.solve(force);
  }

  const MusculoskeletalSystem& arm_;
  const ExcitationSignal& excitation_;
  const ExternalForce& externalForce_;
  SystemConfiguration<N> configuration_;
  Eigen::Index numMuscles_;
  State u_;
  std::vector<FibreRateDerivatives> rate_;  ///< with a rigid tendon the fibre stays as it is
  std::vector<muscles::RigidRate<double>> rigid_;
  std::vector<SchuttePieces> pieces_;  ///< of the last state
  std::size_t hint_ = 0;
  std::size_t externalRow_ = 0;
  Vector qDot_, acceleration_, muscle_, passive_, external_;
  Matrix tau_q_, tau_v_;
  Eigen::LDLT<Matrix> factor_;
};

}  // namespace bio::stepping
