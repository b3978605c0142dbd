#pragma once

// A step of the variational integrator; not public.

#include <fmt/format.h>

#include "simulation/integrators.h"

namespace bio::stepping {

/// One step of the coupled variational scheme and its Newton iteration.
template <int N>
class VariationalStepper {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  VariationalStepper(const MusculoskeletalSystem& arm, const SimulationOptions& options)
      : arm_(arm),
        options_(options),
        configuration_(arm),
        symmetric_(options.integrator == Integrator::variational),
        rate_(arm.numMuscles()),
        pieces_(arm.numMuscles()),
        inverse_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(arm.numMuscles()))),
        residual_(inverse_) {}

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

  /// Solves for the end of a step of length h; `end` holds the first guess of q and fibreLength and
  /// is overwritten (with garbage if not converged).
  /// @param middle  time of the step's middle [s]
  Result solve(double h, double middle, const Ends& begin, const Eigen::VectorXd& activation,
               Ends& end) {
    Result result;
    external_.setZero();
    options_.externalForce.add(middle, row_, external_);
    const double share = symmetric_ ? h / 2 : h;  // of the forces in F⁻
    double previous = 0;                          // largest correction of the iteration before
    Vector at, place;  // where the configuration was computed, and where it is
    for (result.iterations = 1; result.iterations <= options_.maxIterations; ++result.iterations) {
      const Vector q_m = (begin.q + end.q) / 2;
      const Vector v = (end.q - begin.q) / h;
      if (result.iterations > 1 && (q_m - at).cwiseAbs().maxCoeff() < near) {
        configuration_.shift(q_m - place);
      } else {
        configuration_.moveTo(q_m);
        at = q_m;
      }
      place = q_m;
      const InertiaJet<N>& inertia = configuration_.inertia();

      // skeleton: M v and ½ vᵀ∂M v − ∂V with their derivatives in the end configuration
      const Vector Mv = inertia.massMatrix * v;
      Vector L_q = -inertia.dV;
      Matrix dMv = inertia.massMatrix / h;
      Matrix dL_q = -inertia.d2V / 2;
      if (!arm_.skeleton().hasConstantInertia()) {
        for (int k = 0; k < N; ++k) {
          const auto sk = static_cast<std::size_t>(k);
          const Vector M_k_v = inertia.dM[sk] * v;
          L_q[k] += v.dot(M_k_v) / 2;
          dMv.col(k) += M_k_v / 2;
          dL_q.row(k) += M_k_v.transpose() / h;
          for (int j = 0; j < N; ++j) {
            dL_q(k, j) += v.dot(inertia.d2M[static_cast<std::size_t>(pairIndex(k, j))] * v) / 4;
          }
        }
      }

      // passive coordinate forces
      passive_.setZero();
      Matrix tau_q = Matrix::Zero();
      Matrix tau_v = Matrix::Zero();
      arm_.coordinateForces().template add<N>(q_m, v, passive_, tau_q, tau_v);
      const Matrix dPassive = tau_q / 2 + tau_v / h;
      Matrix dTau = dPassive;

      // muscles: forces on the skeleton, and fibre lengths eliminated one by one
      muscle_.setZero();
      Matrix eliminated = Matrix::Zero();
      Vector carried = Vector::Zero();
      for (std::size_t i = 0; i < rate_.size(); ++i) {
        const auto si = static_cast<Eigen::Index>(i);
        const LengthJet<N>& path = configuration_.length(i);
        const double l_m = (begin.fibreLength[si] + end.fibreLength[si]) / 2;
        const SimulatedMuscle& muscle = arm_.muscles()[i].muscle;
        if (!muscle.hasFibreState()) {
          addRigid(i, activation[si], path, v, h, dTau);
          continue;
        }
        rate_[i] =
            muscle.rateNear(activation[si], l_m, path.length,
                            (end.fibreLength[si] - begin.fibreLength[si]) / h, h, pieces_[i]);
        const FibreRateDerivatives& r = rate_[i];
        muscle_ -= r.tendonForce * path.dL_dq;
        dTau.noalias() -= (r.dF_dMuscleTendonLength / 2 * path.dL_dq) * path.dL_dq.transpose();
        dTau -= r.tendonForce / 2 * path.d2L_dq2;
        residual_[si] = (end.fibreLength[si] - begin.fibreLength[si]) / h - r.fibreVelocity;
        inverse_[si] = 1 / (1 / h - r.dV_dFibreLength / 2);
        // G_i C_i/J_i with C = −½ V_L ∂ℓ, G = share·½ F_ℓ ∂ℓ
        const double G = share / 2 * r.dF_dFibreLength;
        eliminated.noalias() -=
            (G * inverse_[si] * r.dV_dMuscleTendonLength / 2 * path.dL_dq) * path.dL_dq.transpose();
        carried += G * inverse_[si] * residual_[si] * path.dL_dq;
      }

      const Vector R = Mv - h / 2 * L_q - share * (muscle_ + passive_ + external_) - begin.p;
      const Matrix J = dMv - h / 2 * dL_q - share * dTau - eliminated;
      Vector dq = solveSmall(J, carried - R);
      if (!dq.allFinite()) return result;

      // trust limits: a step of the arm or of a fibre that is too bold is shortened as a whole
      double shorten = 1;
      double size = dq.cwiseAbs().maxCoeff();
      if (size > largestTurn) shorten = largestTurn / size;
      double fibreSize = 0;
      for (std::size_t i = 0; i < rate_.size(); ++i) {
        const auto si = static_cast<Eigen::Index>(i);
        const LengthJet<N>& path = configuration_.length(i);
        const double C_dq = -rate_[i].dV_dMuscleTendonLength / 2 * path.dL_dq.dot(dq);
        residual_[si] = -(residual_[si] + C_dq) * inverse_[si];  // now δℓ
        fibreSize =
            std::max(fibreSize, std::abs(residual_[si]) * arm_.muscles()[i].muscle.perFibre());
      }
      if (!(fibreSize < 1e6)) return result;
      if (fibreSize * shorten > largestFibreStep) shorten = largestFibreStep / fibreSize;
      end.q += shorten * dq;
      end.fibreLength += shorten * residual_;
      const double correction = std::max(size, fibreSize);
      if (isLast(correction, shorten == 1 ? previous : 0)) {
        // L_q, forces and M v belong to the last iterate but one; to first order in the correction
        for (std::size_t i = 0; i < rate_.size(); ++i) {
          muscle_ -= (rate_[i].dF_dFibreLength / 2 * residual_[static_cast<Eigen::Index>(i)]) *
                     configuration_.length(i).dL_dq;
        }
        muscle_ += (dTau - dPassive) * dq;
        passive_ += dPassive * dq;
        const Vector step = end.q - begin.q;
        end.p = Mv + dMv * dq + h / 2 * (L_q + dL_q * dq) +
                (symmetric_ ? Vector(share * (muscle_ + passive_ + external_))
                            : Vector(Vector::Zero()));
        result.muscleWork = muscle_.dot(step);
        result.passiveWork = passive_.dot(step);
        result.externalWork = external_.dot(step);
        result.converged = true;
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
    if (correction > worthwhile || correction > 0.1 * previous) return false;
    const double ratio = correction / previous;
    return correction * ratio * ratio < 0.01 * options_.newtonTolerance;
  }

  /// Residual of the equations at the last iterate, for the message of a failed step.
  std::string describeResidual() const {
    std::string text;
    for (std::size_t i = 0; i < rate_.size(); ++i) {
      text += fmt::format("{}{} {:.2g} m", i ? ", " : "", arm_.muscles()[i].name,
                          residual_[static_cast<Eigen::Index>(i)]);
    }
    return text;
  }

 private:
  /// Of what shift() is used for [rad] or [m]: changes the motion by at most 1e-11 rad; with 1e-5
  /// it would be more (elbow8, three trials).
  static constexpr double near = 7e-6;
  static constexpr double worthwhile = 1e-4;        ///< corrections above are always followed
  static constexpr double largestTurn = 0.3;        ///< [rad] per iteration
  static constexpr double largestFibreStep = 0.25;  ///< of ℓ0 per iteration

  /// The force of a muscle with a rigid tendon and its derivatives in the end configuration; its
  /// fibre has no equation and stays as it is.
  void addRigid(std::size_t i, double activation, const LengthJet<N>& path, const Vector& v,
                double h, Matrix& dTau) {
    const muscles::RigidRate<double> r =
        arm_.muscles()[i].muscle.rigidRate(activation, path.length, path.dL_dq.dot(v));
    muscle_ -= r.tendonForce * path.dL_dq;
    const Vector F_q = r.dF_dPathLength * path.dL_dq + r.dF_dPathSpeed * (path.d2L_dq2 * v);
    dTau.noalias() -= path.dL_dq * (F_q / 2 + r.dF_dPathSpeed / h * path.dL_dq).transpose();
    dTau -= r.tendonForce / 2 * path.d2L_dq2;
    rate_[i] = {};
    rate_[i].tendonForce = r.tendonForce;
    residual_[static_cast<Eigen::Index>(i)] = 0;
    inverse_[static_cast<Eigen::Index>(i)] = 0;
  }

  static Vector solveSmall(const Matrix& J, const Vector& b) {
    if constexpr (N == 1) {
      return b / J(0, 0);
    } else {
      return J.partialPivLu().solve(b);
    }
  }

  const MusculoskeletalSystem& arm_;
  const SimulationOptions& options_;
  SystemConfiguration<N> configuration_;
  bool symmetric_;
  std::vector<FibreRateDerivatives> rate_;
  std::vector<SchuttePieces> pieces_;  ///< of the last iterate
  Eigen::VectorXd inverse_;
  Eigen::VectorXd residual_;
  Vector muscle_;
  Vector passive_;
  Vector external_;
  std::size_t row_ = 0;  ///< of the external force
};

}  // namespace bio::stepping
