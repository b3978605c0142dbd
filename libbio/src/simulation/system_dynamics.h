#pragma once

// First-order form of the coupled equations, for the explicit and the adaptive integrator.

#include <optional>

#include "simulation/coordinate_sums.h"
#include "simulation/integrators.h"
#include "simulation/other_forces.h"
#include "simulation/tree_rates.h"

namespace bio::stepping {

inline const ExternalForce noExternalForce;
inline const PrescribedMotion nothingPrescribed;

/// ẏ = f(t, y) with y = (q, q̇, activations, fibre lengths); prescribed coordinates take their
/// values from their course, whatever y says:
///     M q̈ = −Σ F_i ∂ℓ_i + τ_passive + τ_external − Ṁ q̇ + ½ q̇ᵀ∂M q̇ − ∂V,   ȧ = activation law,   ℓ̇
///     = V
template <int N>
class SystemDynamics {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using State = Eigen::VectorXd;

  SystemDynamics(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                 const ExternalForce& external = noExternalForce,
                 const PrescribedMotion& prescribed = nothingPrescribed)
      : system_(system),
        excitation_(excitation),
        externalForce_(external),
        prescribed_(prescribed),
        configuration_(system),
        others_(system),
        numCoordinates_(system.skeleton().numCoordinates()),
        numMuscles_(static_cast<Eigen::Index>(system.numMuscles())),
        u_(State::Zero(numMuscles_)),
        rate_(system.numMuscles()),
        rigid_(system.numMuscles()),
        pieces_(system.numMuscles()),
        qDot_(Vector::Zero(numCoordinates_)),
        acceleration_(qDot_),
        muscle_(qDot_),
        passive_(qDot_),
        external_(qDot_),
        along_(qDot_),
        reaction_(qDot_),
        tau_q_(Matrix::Zero(numCoordinates_, numCoordinates_)),
        tau_v_(tau_q_),
        factor_(numCoordinates_) {
    if constexpr (N == Eigen::Dynamic) rates_.emplace(*system.tree());
  }

  Eigen::Index size() const { return 2 * count() + 2 * numMuscles_; }
  /// Parts of a state.
  template <class Y>
  auto coordinates(Y&& y) const {
    return y.head(Eigen::fix<N>(numCoordinates_));
  }
  template <class Y>
  auto speeds(Y&& y) const {
    return y.segment(count(), Eigen::fix<N>(numCoordinates_));
  }
  template <class Y>
  auto activations(Y&& y) const {
    return y.segment(2 * count(), numMuscles_);
  }

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

  /// Puts prescribed coordinates and their speeds where they are at time t.
  template <class Y>
  void place(double t, Y& y) {
    if (prescribed_.empty()) return;
    q_ = coordinates(y);
    qDot_ = speeds(y);
    prescribed_.place(t, q_, qDot_);
    coordinates(y) = q_;
    speeds(y) = qDot_;
  }

  /// f(t, y) into yDot; returns the powers. NaN where a fibre has left its domain.
  template <class Y, class YDot>
  Power derivative(double t, const Y& y, YDot&& yDot) {
    evaluate(t, y);
    coordinates(yDot) = qDot_;
    speeds(yDot) = acceleration_;
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      yDot[2 * count() + i] = system_.muscles()[si].activation.rate(u_[i], y[2 * count() + i]);
      yDot[2 * count() + numMuscles_ + i] = rate_[si].fibreVelocity;
    }
    return {muscle_.dot(qDot_), passive_.dot(qDot_), external_.dot(qDot_) + reaction_.dot(qDot_)};
  }

  /// ∂f/∂y, dense; size() × size().
  template <class Y, class J>
  void jacobian(double t, const Y& y, J&& jacobian) {
    evaluate(t, y);
    jacobian.setZero();
    const auto n = Eigen::fix<N>(numCoordinates_);
    jacobian.block(0, count(), n, n).setIdentity();
    Matrix dForce_dq = tau_q_;
    Matrix dForce_dqDot = tau_v_;
    addInertia(dForce_dq, dForce_dqDot);
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      const FibreRateDerivatives& r = rate_[si];
      const LengthJet<N>& path = configuration_.length(si);
      const auto& law = system_.muscles()[si].activation;
      const Eigen::Index a = 2 * count() + i;
      jacobian(a, a) = law.rateSlope(u_[i], y[a]);
      addSecond<N>(dForce_dq, -r.tendonForce, path);
      if (!system_.muscles()[si].muscle.hasFibreState()) {
        const muscles::RigidRate<double>& rigid = rigid_[si];
        along_ = rigid.dF_dPathLength * path.dL_dq;
        addSecondTimes<N>(along_, rigid.dF_dPathSpeed, path, qDot_);
        dForce_dq.noalias() -= path.dL_dq * along_.transpose();
        addOuter<N>(dForce_dqDot, -rigid.dF_dPathSpeed, path);
        if (!law.isDirect()) {
          jacobian.block(count(), a, n, Eigen::fix<1>) =
              -factor_.solve(Vector(rigid.dF_dActivation * path.dL_dq));
        }
        continue;
      }
      addOuter<N>(dForce_dq, -r.dF_dMuscleTendonLength, path);
      const Eigen::Index l = a + numMuscles_;
      jacobian.block(count(), l, n, Eigen::fix<1>) =
          -factor_.solve(Vector(r.dF_dFibreLength * path.dL_dq));
      jacobian.block(l, 0, Eigen::fix<1>, n) = r.dV_dMuscleTendonLength * path.dL_dq.transpose();
      if (!law.isDirect()) jacobian(l, a) = r.dV_dActivation;
      jacobian(l, l) = r.dV_dFibreLength;
    }
    jacobian.block(count(), 0, n, n) = factor_.solve(dForce_dq);
    jacobian.block(count(), count(), n, n) = factor_.solve(dForce_dqDot);
    for (const int k : system_.prescribed()) {
      for (const Eigen::Index at : {Eigen::Index{k}, count() + k}) {
        jacobian.row(at).setZero();
        jacobian.col(at).setZero();
      }
    }
  }

  /// The last posture in which a path had no taut string; empty: none.
  const State& lostAt() const { return lostAt_; }

  /// Rates at the last state that was evaluated.
  const FibreRateDerivatives& rate(std::size_t muscle) const { return rate_[muscle]; }
  const Vector& acceleration() const { return acceleration_; }
  /// Reaction that keeps the prescribed coordinates on their course; 0 for the others.
  const Vector& reaction() const { return reaction_; }
  const Matrix& massMatrix() const { return massMatrix_; }
  /// Derivatives of all forces but the muscles' and inertia's in the coordinates and speeds.
  const Matrix& tau_q() const { return tau_q_; }
  const Matrix& tau_v() const { return tau_v_; }
  /// For M with the rows and columns of prescribed coordinates replaced by those of the unit
  /// matrix.
  const Eigen::LDLT<Matrix>& factor() const { return factor_; }

  /// Derivatives of −Ṁ q̇ + ½ q̇ᵀ∂M q̇ − ∂V − M q̈ at the last state.
  void addInertia(Matrix& dForce_dq, Matrix& dForce_dqDot) {
    if constexpr (N == Eigen::Dynamic) {
      const EnergyDerivatives<N>& e = configuration_.energy(qDot_);
      dForce_dq += e.T_qq - e.V_qq;
      dForce_dqDot += e.T_vq.transpose() - e.T_vq;
      rates_->evaluate(q_, qDot_);
      dForce_dq -= rates_->momentumRate();
      dForce_dqDot -= rates_->massRate();
      dForce_dq -= configuration_.energy(acceleration_).T_vq;
    } else {
      const InertiaJet<N>& inertia = configuration_.inertia();
      dForce_dq -= inertia.d2V;
      if (system_.skeleton().hasConstantInertia()) return;
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
  }

 private:
  Eigen::Index count() const { return countOf<N>(numCoordinates_); }

  void factorMass(const Matrix& M) {
    if (prescribed_.empty()) {
      factor_.compute(M);
      return;
    }
    massMatrix_ = M;
    reduced_ = M;
    decouple(system_.prescribed(), reduced_);
    factor_.compute(reduced_);
  }

  /// M q̈ = force + reaction, with q̈ given for the prescribed coordinates.
  void solveAcceleration() {
    if (prescribed_.empty()) {
      acceleration_ = factor_.solve(force_);
      return;
    }
    reaction_ = force_;
    for (const auto& course : prescribed_.courses()) {
      reaction_ -= massMatrix_.col(course.coordinate) * acceleration_[course.coordinate];
    }
    for (const auto& course : prescribed_.courses()) {
      reaction_[course.coordinate] = acceleration_[course.coordinate];
    }
    acceleration_ = factor_.solve(reaction_);
    along_.noalias() = massMatrix_ * acceleration_ - force_;
    reaction_.setZero();
    for (const int k : system_.prescribed()) reaction_[k] = along_[k];
  }

  /// −Ṁ q̇ + ½ q̇ᵀ∂M q̇ − ∂V; factors M.
  void addInertia(Vector& force) {
    if constexpr (N == Eigen::Dynamic) {
      const EnergyDerivatives<N>& e = configuration_.energy(qDot_);
      force += e.T_q - e.V_q;
      force.noalias() -= e.T_vq * qDot_;
      factorMass(e.T_vv);
    } else {
      const InertiaJet<N>& inertia = configuration_.inertia();
      force -= inertia.dV;
      if (!system_.skeleton().hasConstantInertia()) {
        for (int k = 0; k < N; ++k) {
          const Vector M_k_v = inertia.dM[static_cast<std::size_t>(k)] * qDot_;
          force[k] += qDot_.dot(M_k_v) / 2;
          force -= qDot_[k] * M_k_v;
        }
      }
      factorMass(inertia.massMatrix);
    }
  }

  template <class Y>
  void evaluate(double t, const Y& y) {
    q_ = coordinates(y);
    const Vector& q = q_;
    qDot_ = speeds(y);
    prescribed_.place(t, q_, qDot_, acceleration_);
    excitation_.at(t, hint_, u_);
    configuration_.moveTo(q);
    passive_.setZero();
    tau_q_.setZero();
    tau_v_.setZero();
    system_.coordinateForces().template add<N>(q, qDot_, passive_, tau_q_, tau_v_);
    external_.setZero();
    externalForce_.add(t, externalRow_, external_);
    if (others_.any()) {
      others_.add(t, configuration_, qDot_, passive_, tau_q_, tau_v_);
      external_ += others_.load();
      tau_q_ += others_.load_q();
    }
    muscle_.setZero();
    for (Eigen::Index i = 0; i < numMuscles_; ++i) {
      const auto si = static_cast<std::size_t>(i);
      const SystemMuscle& muscle = system_.muscles()[si];
      const LengthJet<N>& path = configuration_.length(si);
      if (std::isnan(path.length) && q.allFinite()) lostAt_ = q;
      const double activation = muscle.activation.acting(u_[i], y[2 * count() + i]);
      if (muscle.muscle.hasFibreState()) {
        rate_[si] = muscle.muscle.rate(activation, y[2 * count() + numMuscles_ + i], path.length,
                                       pieces_[si]);
      } else {
        rigid_[si] = muscle.muscle.rigidRate(activation, path.length, path.dL_dq.dot(qDot_));
        rate_[si] = {};
        rate_[si].tendonForce = rigid_[si].tendonForce;
      }
      addAlong<N>(muscle_, -rate_[si].tendonForce, path);
    }
    force_ = muscle_ + passive_ + external_;
    addInertia(force_);
    solveAcceleration();
  }

  const MusculoskeletalSystem& system_;
  const ExcitationSignal& excitation_;
  const ExternalForce& externalForce_;
  const PrescribedMotion& prescribed_;
  SystemConfiguration<N> configuration_;
  OtherForces<N> others_;
  int numCoordinates_;
  Eigen::Index numMuscles_;
  State u_, lostAt_;
  std::vector<FibreRateDerivatives> rate_;  ///< with a rigid tendon the fibre stays as it is
  std::vector<muscles::RigidRate<double>> rigid_;
  std::vector<SchuttePieces> pieces_;  ///< of the last state
  std::size_t hint_ = 0;
  std::size_t externalRow_ = 0;
  Vector q_, qDot_, acceleration_, force_, muscle_, passive_, external_, along_, reaction_;
  Matrix tau_q_, tau_v_;
  Matrix massMatrix_, reduced_;  ///< used where a coordinate is prescribed
  Eigen::LDLT<Matrix> factor_;
  std::optional<TreeRates> rates_;
};

}  // namespace bio::stepping
