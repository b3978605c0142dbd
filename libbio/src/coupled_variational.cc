#include <fmt/format.h>

#include "activation_player.h"
#include "coupled_tape.h"
#include "switch_search.h"

namespace bio::stepping {
namespace {

/// One step of the coupled variational scheme and its Newton iteration.
template <int N>
class VariationalStepper {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  VariationalStepper(const Arm& arm, const SimulationOptions& options)
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
        rate_[i] = fibreRateDerivatives(arm_.muscles()[i].muscle, activation[si], l_m, path.length,
                                        pieces_[i]);
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

  /// What is left of the equations at the last iterate, for the message of a failed step.
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

  static Vector solveSmall(const Matrix& J, const Vector& b) {
    if constexpr (N == 1) {
      return b / J(0, 0);
    } else {
      return J.partialPivLu().solve(b);
    }
  }

  const Arm& arm_;
  const SimulationOptions& options_;
  ArmConfiguration<N> configuration_;
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

template <int N>
class VariationalRun {
 public:
  using Stepper = VariationalStepper<N>;
  using Ends = typename Stepper::Ends;
  using Vector = typename Stepper::Vector;

  VariationalRun(const Arm& arm, const ExcitationSignal& excitation, const ArmState& start,
                 const SimulationOptions& options, StepTape* tape)
      : arm_(arm),
        options_(options),
        tape_(tape),
        stepper_(arm, options),
        player_(arm, excitation, options.startTime),
        configuration_(arm),
        recorder_(arm, numRows(options)),
        activation_(start.activation),
        middle_(start.activation),
        keptActivation_(static_cast<std::size_t>(options.maxHalvings) + 1, start.activation) {
    now_.q = start.q;
    configuration_.moveTo(now_.q);
    now_.p = configuration_.inertia().massMatrix * start.qDot;
    now_.fibreLength = start.fibreLength;
    velocity_ = start.qDot;
    velocityBefore_ = velocity_;
    fibreVelocity_ = Eigen::VectorXd::Zero(start.fibreLength.size());
    fibreVelocityBefore_ = fibreVelocity_;
    length_ = lengthBefore_ = options.step;
    next_ = now_;
    recorder_.add(options.startTime, now_.q, start.qDot, activation_, now_.fibreLength, 0, 0, 0);
    if (tape_) tape_->begin(now_.q, now_.fibreLength, activation_);
  }

  Trajectory run() {
    const StopWatch watch;
    const std::size_t rows = numRows(options_);
    Trajectory& trajectory = recorder_.trajectory();
    TimeMark begin = markRow(rowTime(options_, 0));
    for (std::size_t k = 1; k < rows; ++k) {
      const TimeMark end = markRow(rowTime(options_, k));
      const double t0 = begin.value;
      const double t1 = end.value;
      if (!advance(begin, end, 0)) {
        trajectory.outcome = Outcome::noSolution;
        trajectory.failedAt = t0;
        trajectory.why = fmt::format(
            "no solution at t = {:.6g} s: the smallest step, {:.3g} s, did not converge (last "
            "corrections: {})",
            t0, (t1 - t0) / std::pow(2, options_.maxHalvings), stepper_.describeResidual());
        break;
      }
      begin = end;
      ++trajectory.steps;
      if (tape_) tape_->endRow();
      recorder_.add(t1, now_.q, speed(), activation_, now_.fibreLength, muscleWork_, passiveWork_,
                    externalWork_);
      if (options_.progress && !options_.progress(t1)) {
        trajectory.outcome = Outcome::stopped;
        trajectory.failedAt = t1;
        trajectory.why = fmt::format("stopped at t = {:.6g} s", t1);
        break;
      }
    }
    trajectory.wallSeconds = watch.seconds();
    return recorder_.finish();
  }

 private:
  /// Moves now_ and activation_ from t0 to t1; in halves, and halves of them, where Newton fails,
  /// and in two parts where a conditional path point comes or goes.
  bool advance(const TimeMark& begin, const TimeMark& end, int depth) {
    const double t0 = begin.value;
    const double t1 = end.value;
    Eigen::VectorXd& kept = keptActivation_[static_cast<std::size_t>(depth)];
    kept = activation_;
    if (solve(t0, t1)) {
      double split = 0;
      const PathSwitch* met = findSwitch(t0, t1, kept, split);
      if (met == nullptr) {
        accept(begin, end);
        return true;
      }
      const TimeMark middle = markSwitch(split, *met);
      accept(begin, middle);
      return advance(middle, end, depth);
    }
    if (depth >= options_.maxHalvings) return false;
    if (depth == 0) ++recorder_.trajectory().halvedSteps;
    activation_ = kept;
    player_.restart(t0);
    const TimeMark middle = markMiddle(begin, end);
    return advance(begin, middle, depth + 1) && advance(middle, end, depth + 1);
  }

  TimeMark markRow(double time) { return {time, tape_ ? tape_->addRow(time) : 0}; }
  TimeMark markSwitch(double time, const PathSwitch& met) {
    return {time, tape_ ? tape_->addSwitch(time, met) : 0};
  }
  TimeMark markMiddle(const TimeMark& begin, const TimeMark& end) {
    const double time = begin.value + (end.value - begin.value) / 2;
    return {time, tape_ ? tape_->addMiddle(time, begin.index, end.index) : 0};
  }

  /// One step from now_ into next_, activation_ moved along.
  bool solve(double t0, double t1) {
    const double h = t1 - t0;
    const double tMiddle = t0 + h / 2;
    player_.advance(t0, tMiddle, activation_);
    middle_ = activation_;
    player_.advance(tMiddle, t1, activation_);
    // the parabola through the last three ends
    const double bend = h * (h + length_) / (length_ + lengthBefore_);
    next_.q = now_.q + (h + bend) * velocity_ - bend * velocityBefore_;
    next_.fibreLength =
        now_.fibreLength + (h + bend) * fibreVelocity_ - bend * fibreVelocityBefore_;
    result_ = stepper_.solve(h, tMiddle, now_, middle_, next_);
    count(result_.iterations);
    if (!result_.converged) {  // again from rest, in case the extrapolation was the trouble
      next_.q = now_.q;
      next_.fibreLength = now_.fibreLength;
      result_ = stepper_.solve(h, tMiddle, now_, middle_, next_);
      count(result_.iterations);
    }
    return result_.converged;
  }

  /// If a path gains or loses points within the step just solved: shortens the step to end there.
  /// Returns which switch it then ends on, or null.
  const PathSwitch* findSwitch(double t0, double t1, const Eigen::VectorXd& activationAtStart,
                               double& split) {
    SwitchSearch search(options_.newtonTolerance);
    if (!search.begin(arm_.switches(), now_.q, next_.q)) return nullptr;
    for (auto found = SwitchSearch::Found::again; found == SwitchSearch::Found::again;) {
      split = t0 + search.fraction() * (t1 - t0);
      activation_ = activationAtStart;
      player_.restart(t0);
      if (!solve(t0, split)) break;
      found = search.take(next_.q[search.which().freeIndex]);
      if (found == SwitchSearch::Found::met) return &search.which();
    }
    // not to be met exactly: take the whole step as it is
    activation_ = activationAtStart;
    player_.restart(t0);
    solve(t0, t1);
    return nullptr;
  }

  /// next_ becomes now_.
  void accept(const TimeMark& begin, const TimeMark& end) {
    const double h = end.value - begin.value;
    if (tape_) tape_->add(begin.index, end.index, next_.q, next_.fibreLength, middle_, activation_);
    velocityBefore_ = velocity_;
    velocity_ = (next_.q - now_.q) / h;
    fibreVelocityBefore_.swap(fibreVelocity_);
    fibreVelocity_ = (next_.fibreLength - now_.fibreLength) / h;
    lengthBefore_ = length_;
    length_ = h;
    now_.q.swap(next_.q);
    now_.p.swap(next_.p);
    now_.fibreLength.swap(next_.fibreLength);
    muscleWork_ += result_.muscleWork;
    passiveWork_ += result_.passiveWork;
    externalWork_ += result_.externalWork;
  }

  void count(int iterations) {
    recorder_.trajectory().newtonIterations += std::min(iterations, options_.maxIterations);
  }

  /// q̇ = M⁻¹p at the end of the last step.
  Vector speed() {
    if (!arm_.skeleton().hasConstantInertia()) configuration_.moveSkeletonTo(now_.q);
    return configuration_.inertia().massMatrix.ldlt().solve(now_.p);
  }

  const Arm& arm_;
  const SimulationOptions& options_;
  StepTape* tape_;
  Stepper stepper_;
  ActivationPlayer player_;
  ArmConfiguration<N> configuration_;
  Recorder recorder_;
  Eigen::VectorXd activation_, middle_;
  Ends now_, next_;
  // mean speeds of the last two steps, and their lengths [s]
  Vector velocity_, velocityBefore_;
  Eigen::VectorXd fibreVelocity_, fibreVelocityBefore_;
  double length_, lengthBefore_;
  double muscleWork_ = 0;
  double passiveWork_ = 0;
  double externalWork_ = 0;
  std::vector<Eigen::VectorXd> keptActivation_;  ///< one per depth of halving
  typename Stepper::Result result_;
};

}  // namespace

Trajectory simulateVariational(const Arm& arm, const ExcitationSignal& excitation,
                               const ArmState& start, const SimulationOptions& options,
                               StepTape* tape) {
  return withCoordinates(arm.skeleton().numCoordinates(), [&](auto N) {
    return VariationalRun<decltype(N)::value>(arm, excitation, start, options, tape).run();
  });
}

}  // namespace bio::stepping
