#pragma once

// A step of the variational integrator, transposed; not public.

#include "sensitivity/excitation_adjoint.h"
#include "sensitivity/gradient_sums.h"
#include "sensitivity/linearised_step.h"

namespace bio::stepping {

/// dJ/d(state): covectors of what SensitivityState carries.
template <int N>
struct AdjointState {
  Eigen::Matrix<double, N, 1> q, p;
  Eigen::VectorXd fibre, activation;

  explicit AdjointState(const MusculoskeletalSystem& system) {
    q.setZero(countOf<N>(system));
    p.setZero(countOf<N>(system));
    fibre.setZero(static_cast<Eigen::Index>(system.numMuscles()));
    activation = fibre;
  }
  void setZero() {
    q.setZero();
    p.setZero();
    fibre.setZero();
    activation.setZero();
  }
};

/// Carries dJ/d(state) back over a step, by the transposed equations of SensitivityStep.
template <int N>
class AdjointStep {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::Matrix<double, N, 1>;
  using State = AdjointState<N>;

  AdjointStep(const MusculoskeletalSystem& system, const SimulationOptions& options,
              SystemConfiguration<N>& configuration, GradientSums<N>& sums,
              ExcitationAdjoint& excitation)
      : system_(system),
        options_(options),
        configuration_(configuration),
        sums_(sums),
        excitation_(excitation),
        step_(system, options, configuration),
        middleActivation_(Eigen::VectorXd::Zero(static_cast<Index>(system.numMuscles()))) {}

  /// To part i of the tape, for calls of pullBack.
  void moveTo(const StepTape& tape, std::size_t i) {
    step_.moveTo(tape, i);
    tape_ = &tape;
    part_ = i;
  }

  using InTimes = ExcitationAdjoint::InTimes;
  /// Replaces dJ/d(state) at the part's end by that at its begin.
  /// @param gathers  whether dJ in the parameters is added to the sums as well
  /// @return dJ in the times of both ends
  InTimes pullBack(State& state, bool gathers) {
    // through q′, p′ and ℓ′ to the residual R and to the force
    toEnd_ = state.q;
    toEnd_.noalias() += step_.momentumAtEnd().transpose() * state.p;
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      addAlong<N>(toEnd_, step_.muscle(m).half * state.fibre[static_cast<Index>(m)],
                  configuration_.length(m));
    }
    mu_.noalias() = step_.perJ().transpose() * toEnd_;
    toForce_ = step_.share() * mu_ + step_.endShare() * state.p;
    state.q.noalias() = step_.momentumAtBegin().transpose() * state.p;
    state.q.noalias() -= step_.residualAtBegin().transpose() * mu_;
    double inLength = step_.momentumInLength().dot(state.p) - step_.residualInLength().dot(mu_);
    if (gathers) {
      toSlope_ = step_.h() / 2 * (mu_ + state.p);
      toMomentum_ = state.p - mu_;
      sums_.addInertia(step_.v(), toMomentum_, toSlope_);
      sums_.addOtherForces(step_.middle(), step_.q_m(), step_.v(), options_.externalForce,
                           toForce_);
    }
    state.p = mu_;
    for (std::size_t m = 0; m < system_.numMuscles(); ++m) {
      if (step_.muscle(m).hasFibre) {
        inLength += addElastic(m, gathers, state);
      } else {
        addRigid(m, gathers, state);
      }
    }

    // activations, and the times of both ends and of the middle
    const InTimes second = excitation_.pullBack(
        step_.middle(), step_.end(), tape_->middleActivation(part_ + 1), state.activation, gathers);
    state.activation += middleActivation_;
    const InTimes first = excitation_.pullBack(step_.begin(), step_.middle(),
                                               tape_->activation(part_), state.activation, gathers);
    double inMiddle = second.begin + first.end;
    if (!options_.externalForce.empty()) inMiddle += step_.externalSlope().dot(toForce_);
    if (step_.others().any()) inMiddle += step_.others().load_t().dot(toForce_);
    InTimes times{first.begin + inMiddle / 2 - inLength, second.end + inMiddle / 2 + inLength};
    if (!system_.prescribed().empty()) {
      times.end += toEnd_.dot(Vector(step_.givenColumns() * step_.givenSpeeds()));
    }
    return times;
  }

 private:
  /// @return what it adds to dJ/dh
  double addElastic(std::size_t m, bool gathers, State& state) {
    const auto sm = static_cast<Index>(m);
    const auto& here = step_.muscle(m);
    const FibreRateDerivatives& r = here.r;
    const LengthJet<N>& path = configuration_.length(m);
    const double along = alongForce(path);
    const double throughForce = -(r.dF_dFibreLength / 2) * along;
    const double toTrial = state.fibre[sm] + throughForce;
    const double toRate = here.perJ * toTrial;
    state.fibre[sm] = throughForce + (1 / step_.h() + r.dV_dFibreLength / 2) * toRate;
    middleActivation_[sm] = r.dV_dActivation * toRate;
    addAlong<N>(state.q, here.half * toTrial, path);
    if (!gathers) return here.stretch / (step_.h() * step_.h()) * toRate;
    const SimulatedMuscle& muscle = system_.muscles()[m].muscle;
    if (sums_.hasNumbers(m)) {
      const SimulatedMuscle::InNumbers d =
          muscle.inNumbers(here.activation, here.l_m, path.length, here.l_v, step_.pieces(m));
      sums_.addNumbers(m, toRate, d.dV);
      sums_.addNumbers(m, -along, d.dF);
      if (here.isHeld) sums_.addNumbers(m, toTrial, muscle.shortestInNumbers());
    }
    if (sums_.hasGeometry(m)) {
      auto& w = weights(path);
      w[0] = r.dV_dMuscleTendonLength * toRate - r.dF_dMuscleTendonLength * along;
      forEachMoved<N>(path, [&](int k, int slot) { w[1 + slot] = -r.tendonForce * toForce_[k]; });
      sums_.addGeometry(m, step_.q_m(), w);
    }
    return here.stretch / (step_.h() * step_.h()) * toRate;
  }

  void addRigid(std::size_t m, bool gathers, State& state) {
    const auto sm = static_cast<Index>(m);
    const auto& here = step_.muscle(m);
    const muscles::RigidRate<double>& r = here.rigid;
    const LengthJet<N>& path = configuration_.length(m);
    const double along = alongForce(path);
    state.fibre[sm] = 0;
    middleActivation_[sm] = -r.dF_dActivation * along;
    if (!gathers) return;
    if (sums_.hasNumbers(m)) {
      sums_.addNumbers(
          m, -along,
          system_.muscles()[m].muscle.rigidInNumbers(here.activation, path.length, here.speed));
    }
    if (sums_.hasGeometry(m)) {
      auto& w = weights(path);
      w[0] = -r.dF_dPathLength * along;
      forEachMoved<N>(path, [&](int k, int slot) {
        w[1 + slot] = -r.dF_dPathSpeed * along * step_.v()[k] - r.tendonForce * toForce_[k];
      });
      sums_.addGeometry(m, step_.q_m(), w);
    }
  }

  /// ∂ℓ·λ_f
  double alongForce(const LengthJet<N>& path) const {
    double along = 0;
    forEachMoved<N>(path, [&](int k, int) { along += path.dL_dq[k] * toForce_[k]; });
    return along;
  }

  /// One for ∂_θℓ and one for each ∂_θ∂_kℓ of a path.
  auto& weights(const LengthJet<N>& path) {
    if constexpr (N == Eigen::Dynamic) {
      weights_.resize(1 + static_cast<Index>(path.support.size()));
    }
    return weights_;
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  SystemConfiguration<N>& configuration_;
  GradientSums<N>& sums_;
  ExcitationAdjoint& excitation_;
  LinearisedStep<N> step_;
  const StepTape* tape_ = nullptr;
  std::size_t part_ = 0;
  Vector toEnd_, mu_, toForce_, toSlope_, toMomentum_;
  Eigen::Matrix<double, N == Eigen::Dynamic ? N : N + 1, 1> weights_;
  Eigen::VectorXd middleActivation_;
};

}  // namespace bio::stepping
