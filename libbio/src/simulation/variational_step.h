#pragma once

// A step of the variational integrator; not public.

#include <fmt/format.h>

#include <limits>

#include "simulation/coordinate_sums.h"
#include "simulation/integrators.h"
#include "simulation/newton_limits.h"
#include "simulation/other_forces.h"
#include "simulation/step_control.h"

namespace bio::stepping {

/// One step of the coupled variational scheme and its Newton iteration.
template <int N>
class VariationalStepper {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  VariationalStepper(const MusculoskeletalSystem& system, const SimulationOptions& options)
      : system_(system),
        options_(options),
        configuration_(system),
        others_(system),
        symmetric_(isSymmetric(options.integrator)),
        mayShift_(N == Eigen::Dynamic || system.bodyForces().empty()),
        enough_(negligible * allowedError(options)),
        rate_(system.numMuscles()),
        pieces_(system.numMuscles()),
        inverse_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.numMuscles()))),
        residual_(inverse_),
        muscle_(Vector::Zero(countOf<N>(system))),
        passive_(muscle_),
        external_(muscle_),
        work_(countOf<N>(system)) {}

  struct Ends {
    Vector q, p;
    Eigen::VectorXd fibreLength;
  };

  struct Result {
    bool converged = false;
    int iterations = 0;
    double muscleWork = 0;  ///< f_muscle·(q' − q)
    double passiveWork = 0;
    double externalWork = 0;
  };

  /// Solves for the end of a step of length h; `end` holds the first guess of q and fibreLength,
  /// and the prescribed coordinates where they are to end, and is overwritten (with garbage if not
  /// converged).
  /// @param middle  time of the step's middle [s]
  Result solve(double h, double middle, const Ends& begin, const Eigen::VectorXd& activation,
               Ends& end) {
    Result result;
    external_.setZero();
    options_.externalForce.add(middle, row_, external_);
    if (others_.any()) applied_ = external_;
    const double share = symmetric_ ? h / 2 : h;  // of the forces in F⁻
    double previous = 0;                          // largest correction of the iteration before
    // where the configuration was computed, and where it is
    auto&& at = work_.template vector<0>();
    auto&& place = work_.template vector<1>();
    auto&& q_m = work_.template vector<2>();
    auto&& v = work_.template vector<3>();
    auto&& L_q = work_.template vector<4>();
    auto&& carried = work_.template vector<5>();
    auto&& dq = work_.template vector<6>();
    auto&& R = work_.template vector<7>();
    auto&& dMv = work_.template matrix<0>();
    auto&& dL_q = work_.template matrix<1>();
    auto&& tau_q = work_.template matrix<2>();
    auto&& tau_v = work_.template matrix<3>();
    auto&& dPassive = work_.template matrix<4>();
    auto&& dTau = work_.template matrix<5>();
    auto&& eliminated = work_.template matrix<6>();
    auto&& J = work_.template matrix<7>();
    for (result.iterations = 1; result.iterations <= options_.maxIterations; ++result.iterations) {
      q_m = (begin.q + end.q) / 2;
      v = (end.q - begin.q) / h;
      if (result.iterations > 1 && mayShift_ && (q_m - at).cwiseAbs().maxCoeff() < newton::near) {
        dq = q_m - place;
        configuration_.shift(dq);
      } else {
        configuration_.moveTo(q_m);
        at = q_m;
      }
      place = q_m;

      // skeleton: M v and ½ vᵀ∂M v − ∂V with their derivatives in the end configuration
      const EnergyDerivatives<N>& energy = configuration_.energy(v);
      const Vector& Mv = energy.T_v;
      L_q = -energy.V_q;
      dMv = energy.T_vv / h;
      dL_q = -energy.V_qq / 2;
      if (!system_.skeleton().hasConstantInertia()) {
        L_q += energy.T_q;
        dMv += energy.T_vq / 2;
        dL_q += energy.T_vq.transpose() / h;
        dL_q += energy.T_qq / 2;
      }

      // passive coordinate forces
      passive_.setZero();
      tau_q.setZero(countOf<N>(system_), countOf<N>(system_));
      tau_v.setZero(countOf<N>(system_), countOf<N>(system_));
      system_.coordinateForces().template add<N>(q_m, v, passive_, tau_q, tau_v);
      if (others_.any()) {
        others_.add(middle, configuration_, v, passive_, tau_q, tau_v);
        external_ = applied_ + others_.load();
      }
      dPassive = tau_q / 2 + tau_v / h;
      dTau = dPassive;
      if (others_.any()) dTau += others_.load_q() / 2;

      addMuscles(begin, end, activation, {v, h, share, result.iterations == 1}, dTau, eliminated,
                 carried);

      R = Mv - h / 2 * L_q - share * (muscle_ + passive_ + external_) - begin.p;
      J = dMv - h / 2 * dL_q - share * dTau - eliminated;
      carried -= R;
      for (const int k : system_.prescribed()) {  // q' is given
        J.row(k).setZero();
        J(k, k) = 1;
        carried[k] = 0;
      }
      solveSmall(J, carried, dq);
      if (!dq.allFinite()) {
        failedPosture_ = q_m;
        return result;
      }

      const double size = dq.cwiseAbs().maxCoeff();
      const double fibreSize = correctFibres(dq);
      if (!(fibreSize < 1e6)) return result;
      const double shorten = shareWithinLimits(size, fibreSize);
      end.q += shorten * dq;
      end.fibreLength += shorten * residual_;
      const double correction = std::max(size, fibreSize);
      if (isEnough(result.iterations, correction, shorten == 1 && !settled_ ? previous : 0)) {
        finish(begin, h, share, {Mv, dq, dMv, dL_q, dPassive}, L_q, dTau, R, end, result);
        result.converged = true;
        failedPosture_.resize(0);
        return result;
      }
      previous = correction;
    }
    return result;
  }

  /// Newton's corrections fall quadratically, x₃ ≈ x₂·(x₂/x₁)²: is the next one within the
  /// tolerance?
  /// @param previous  the correction before, 0: none that tells
  bool isLast(double correction, double previous) const {
    if (correction < options_.newtonTolerance) return true;
    if (correction > newton::worthwhile || correction > 0.1 * previous) return false;
    const double ratio = correction / previous;
    return correction * ratio * ratio < 0.01 * options_.newtonTolerance;
  }

  /// isLast(), or in vi-adaptive: is what this correction leaves small beside the error that the
  /// part may have? After a first one x₁ it is c x₁², with c as in the last part with a second.
  bool isEnough(int iteration, double correction, double previous) {
    if (iteration == 2 && previous > 0) contraction_ = correction / (previous * previous);
    if (isLast(correction, previous)) return true;
    if (!(enough_ > 0) || correction > 0.01) return false;
    if (iteration == 1) return contraction_ * correction * correction < enough_;
    const double ratio = correction / previous;
    return ratio < 0.5 && correction * ratio * ratio < enough_;
  }

  /// A path that was lost, else the residual of the equations at the last iterate: for the message
  /// of a failed step.
  std::string describeFailure() const {
    if (failedPosture_.size() > 0) {
      const std::string lost = describeLostPath(system_, failedPosture_);
      if (!lost.empty()) return lost;
    }
    std::string text = "last corrections: ";
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      text += fmt::format("{}{} {:.2g} m", i ? ", " : "", system_.muscles()[i].name,
                          residual_[static_cast<Eigen::Index>(i)]);
    }
    return text;
  }

 private:
  /// A correction of the system or of a fibre that is too bold is shortened as a whole.
  static double shareWithinLimits(double size, double fibreSize) {
    double share = 1;
    if (size > newton::largestTurn) share = newton::largestTurn / size;
    if (fibreSize * share > newton::largestFibreStep) share = newton::largestFibreStep / fibreSize;
    return share;
  }

  struct Moving {
    const Vector& v;
    double h, share;
    bool isFirst;  ///< iteration
  };
  /// Forces of the muscles on the skeleton, and fibre lengths eliminated one by one.
  void addMuscles(const Ends& begin, Ends& end, const Eigen::VectorXd& activation,
                  const Moving& step, Matrix& dTau, Matrix& eliminated, Vector& carried) {
    const auto& [v, h, share, isFirst] = step;
    settled_ = false;
    muscle_.setZero();
    eliminated.setZero(countOf<N>(system_), countOf<N>(system_));
    carried.setZero(countOf<N>(system_));
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      const auto si = static_cast<Eigen::Index>(i);
      const LengthJet<N>& path = configuration_.length(i);
      if (!system_.muscles()[i].muscle.hasFibreState()) {
        addRigid(i, activation[si], path, v, h, dTau);
        continue;
      }
      settleFibre(i, begin.fibreLength[si], activation[si], path.length, step, end.fibreLength[si]);
      const FibreRateDerivatives& r = rate_[i];
      addAlong<N>(muscle_, -r.tendonForce, path);
      // G_i C_i/J_i with C = −½ V_L ∂ℓ, G = share·½ F_ℓ ∂ℓ
      const double G = share / 2 * r.dF_dFibreLength;
      addStiffness<N>(dTau, -(r.dF_dMuscleTendonLength / 2), -(r.tendonForce / 2), eliminated,
                      -(G * inverse_[si] * r.dV_dMuscleTendonLength / 2), path);
      addAlong<N>(carried, G * inverse_[si] * residual_[si], path);
    }
  }

  /// Rate, residual and 1/J of a fibre that ends at `end`, for this iteration's length of the path.
  /// Returns its correction by itself [m].
  double evaluateFibre(std::size_t i, double begin, double activation, double pathLength, double h,
                       double end) {
    const auto si = static_cast<Eigen::Index>(i);
    const double velocity = (end - begin) / h;
    rate_[i] = system_.muscles()[i].muscle.rateNear(activation, (begin + end) / 2, pathLength,
                                                    velocity, h, pieces_[i]);
    residual_[si] = velocity - rate_[i].fibreVelocity;
    inverse_[si] = 1 / (1 / h - rate_[i].dV_dFibreLength / 2);
    return -residual_[si] * inverse_[si];
  }

  /// evaluateFibre(); where the correction would be a bold one, the fibre's own equation is solved
  /// first, by Newton's method within a bracket (its residual rises with `end`): that takes a rate
  /// of one muscle at a time, where the system's iteration takes every path.
  void settleFibre(std::size_t i, double begin, double activation, double pathLength,
                   const Moving& step, double& end) {
    const double perFibre = system_.muscles()[i].muscle.perFibre();
    const auto isAbove = [&](double correction, double limit) {
      return std::abs(correction) * perFibre > limit;
    };
    double correction = evaluateFibre(i, begin, activation, pathLength, step.h, end);
    if (!isAbove(correction, step.isFirst ? newton::boldAtFirst : newton::bold)) return;
    settled_ = true;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    for (int tries = 0; tries < newton::mostTries; ++tries) {
      (correction < 0 ? high : low) = end;
      end += correction;
      if (!(low < end && end < high)) end = (low + high) / 2;
      correction = evaluateFibre(i, begin, activation, pathLength, step.h, end);
      if (!isAbove(correction, newton::bold)) return;
    }
  }

  /// Makes fibres' corrections of their residuals; the largest, of ℓ0.
  double correctFibres(const Vector& dq) {
    double largest = 0;
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      const auto si = static_cast<Eigen::Index>(i);
      const LengthJet<N>& path = configuration_.length(i);
      const double C_dq = -rate_[i].dV_dMuscleTendonLength / 2 * path.dL_dq.dot(dq);
      residual_[si] = -(residual_[si] + C_dq) * inverse_[si];
      largest = std::max(largest, std::abs(residual_[si]) * system_.muscles()[i].muscle.perFibre());
    }
    return largest;
  }

  struct LastIterate {
    const Vector &Mv, &dq;
    const Matrix &dMv, &dL_q, &dPassive;
  };
  /// The momentum at the end, and the work of the forces.
  void finish(const Ends& begin, double h, double share, const LastIterate& last, Vector& L_q,
              Matrix& dTau, Vector& R, Ends& end, Result& result) {
    const auto& [Mv, dq, dMv, dL_q, dPassive] = last;
    // L_q, forces and M v belong to the last iterate but one; to first order in the correction
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      addAlong<N>(muscle_,
                  -(rate_[i].dF_dFibreLength / 2 * residual_[static_cast<Eigen::Index>(i)]),
                  configuration_.length(i));
    }
    dTau -= dPassive;
    if (others_.any()) {
      dTau -= others_.load_q() / 2;
      external_ += others_.load_q() / 2 * dq;
    }
    muscle_.noalias() += dTau * dq;
    passive_.noalias() += dPassive * dq;
    const auto step = end.q - begin.q;
    R.noalias() = dL_q * dq;
    L_q += R;
    R.noalias() = dMv * dq;
    end.p = Mv + R + h / 2 * L_q;
    if (symmetric_) end.p += share * (muscle_ + passive_ + external_);
    result.muscleWork = muscle_.dot(step);
    result.passiveWork = passive_.dot(step);
    result.externalWork = external_.dot(step);
  }

  /// The force of a muscle with a rigid tendon and its derivatives in the end configuration; its
  /// fibre has no equation and stays as it is.
  void addRigid(std::size_t i, double activation, const LengthJet<N>& path, const Vector& v,
                double h, Matrix& dTau) {
    const muscles::RigidRate<double> r =
        system_.muscles()[i].muscle.rigidRate(activation, path.length, path.dL_dq.dot(v));
    addAlong<N>(muscle_, -r.tendonForce, path);
    // ∂F over the end configuration
    auto&& F_q = work_.template vector<8>();
    F_q = (r.dF_dPathLength / 2 + r.dF_dPathSpeed / h) * path.dL_dq;
    addSecondTimes<N>(F_q, r.dF_dPathSpeed / 2, path, v);
    dTau.noalias() -= path.dL_dq * F_q.transpose();
    addSecond<N>(dTau, -(r.tendonForce / 2), path);
    rate_[i] = {};
    rate_[i].tendonForce = r.tendonForce;
    residual_[static_cast<Eigen::Index>(i)] = 0;
    inverse_[static_cast<Eigen::Index>(i)] = 0;
  }

  void solveSmall(const Matrix& J, const Vector& b, Vector& x) {
    if constexpr (N == 1) {
      x = b / J(0, 0);
    } else {
      factor_.compute(J);
      x = factor_.solve(b);
    }
  }

  const MusculoskeletalSystem& system_;
  const SimulationOptions& options_;
  SystemConfiguration<N> configuration_;
  OtherForces<N> others_;
  bool symmetric_;
  /// A fibre did, in this iteration: the correction before does not tell what it makes of this.
  bool settled_ = false;
  bool mayShift_;  ///< not where forces ask for placements, which a shift may not move
  /// What Newton's method may leave, as a share of the error of a part; how little it matters:
  /// decision 092.
  static constexpr double negligible = 0.0075;
  double enough_;  ///< 0, or what may be left of the unknowns [rad], [m] or ℓ0
  double contraction_ = std::numeric_limits<double>::infinity();
  std::vector<FibreRateDerivatives> rate_;
  std::vector<SchuttePieces> pieces_;  ///< of the last iterate
  Eigen::VectorXd inverse_;
  Eigen::VectorXd residual_;
  Vector muscle_;
  Vector passive_;
  Vector external_, applied_;      ///< the latter: what a trial applies to coordinates
  Eigen::VectorXd failedPosture_;  ///< in which the last step failed without a number
  Scratch<N, 9, 8> work_;
  Eigen::PartialPivLU<Matrix> factor_;
  std::size_t row_ = 0;  ///< of the external force
};

}  // namespace bio::stepping
