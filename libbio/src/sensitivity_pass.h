#pragma once

// The pass along the tape of a run that carries its sensitivities; not public.

#include "bio/coupled_sensitivity.h"
#include "bio/skeleton_motion.h"
#include "coupled_tape.h"
#include "excitation_sensitivity.h"
#include "parameter_effects.h"

namespace bio::stepping {

/// Carries d(state)/dθ along the tape. Behind the parameters stands one more column: in it, at a
/// switch of a path, runs the derivative in the time of the switch. Behind it stand the nodes of an
/// external force, each of which is 0, and not computed, until its hat begins.
template <int N>
class SensitivityPass {
 public:
  using Index = Eigen::Index;
  using RowVector = Eigen::RowVectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using Rows = Eigen::Matrix<double, N, Eigen::Dynamic, Eigen::RowMajor>;

  SensitivityPass(const Arm& arm, const ParameterEffects& effects,
                  const ParameterCatalogue::Setting& setting, const ExcitationSignal& trial,
                  const ExcitationSignal& driven, Index numParameters,
                  const SensitivityOptions& options)
      : arm_(arm),
        effects_(effects),
        options_(options),
        symmetric_(options.simulation.integrator == Integrator::variational),
        numParameters_(numParameters),
        numMuscles_(static_cast<Index>(arm.numMuscles())),
        nodes_(options.externalNodes),
        configuration_(arm),
        excitation_(arm, effects, trial, driven, setting.mapping) {
    const Index columns = numParameters + 1;
    dq_.setZero(N, columns);
    dp_.setZero(N, columns);
    forward_.setZero(N, columns);
    force_.setZero(N, columns);
    inertia_.setZero(N, columns);
    slope_.setZero(N, columns);
    fibre_.setZero(numMuscles_, columns);
    trialFibre_ = fibre_;
    activation_.setZero(numMuscles_, static_cast<Index>(excitation_.columns().size()));
    middle_ = activation_;
    row_.setZero(columns);
    unit_ = row_;
    unit_[numParameters] = 1;
    for (const ArmMuscle& muscle : arm.muscles()) {
      gradients_.emplace_back(setting.model, arm.skeleton(), findMuscle(setting.model, muscle.name),
                              muscle.path);
      workspaces_.push_back(gradients_.back().template workspace<N>());
    }
  }

  SensitivityTrajectory run(Trajectory motion, const ArmState& start, const StepTape& tape) {
    const StopWatch watch;
    SensitivityTrajectory result;
    result.motion = std::move(motion);
    const auto rows = static_cast<Index>(result.motion.time.size());
    const auto room = [&](std::size_t count) {
      return std::vector<SensitivityMatrix>(count, SensitivityMatrix(rows, numParameters_));
    };
    result.q = room(N);
    result.qDot = room(N);
    if (options_.muscles) {
      result.fibreLength = result.activation = result.tendonForce = room(arm_.numMuscles());
    }
    const auto numNodes = static_cast<Index>(nodes_.times.size());
    if (numNodes > 0) {
      result.qOfNodes.assign(N, SensitivityMatrix::Zero(rows, numNodes));
      result.qDotOfNodes = result.qOfNodes;
    }
    begin(start, result.motion.time.front());
    Index row = 0;
    record(row, result);
    times_.assign(tape.times().size(), RowVector());
    for (std::size_t i = 0; i < tape.parts().size(); ++i) {
      follow(tape, i);
      if (tape.parts()[i].endsRow && ++row < rows) record(row, result);
    }
    result.wallSeconds = watch.seconds();
    return result;
  }

 private:
  // The start -------------------------------------------------------------------------------------

  void begin(const ArmState& start, double time) {
    const Vector q = start.q;
    const Vector qDot = start.qDot;
    configuration_.moveTo(q);
    const InertiaJet<N>& inertia = configuration_.inertia();
    dq_.setZero();
    dp_.setZero();
    for (const auto& effect : effects_.start) {
      if (effect.isSpeed) {
        dp_.col(effect.column) += effect.weight * inertia.massMatrix.col(effect.coordinate);
      } else {
        dq_(effect.coordinate, effect.column) += effect.weight;
      }
    }
    // p = M q̇
    addInertia(qDot);
    dp_ += inertia_;
    for (int k = 0; k < N; ++k) {
      dp_ += (inertia.dM[static_cast<std::size_t>(k)] * qDot) * dq_.row(k);
    }
    excitation_.start(time, activation_);
    // the fibres rest: ℓ follows activation, ℓ_MT and the muscle's own parameters
    for (std::size_t i = 0; i < arm_.numMuscles(); ++i) {
      const auto si = static_cast<Index>(i);
      const SchutteMuscle<double>& muscle = arm_.muscles()[i].muscle;
      const LengthJet<N>& path = configuration_.length(i);
      const StaticEquilibrium rest = staticEquilibrium(muscle, start.activation[si], path.length);
      const EquilibriumDerivatives d =
          equilibriumDerivatives(muscle, start.activation[si], path.length, rest);
      auto fibre = fibre_.row(si);
      fibre = d.dl_dMuscleTendonLength * (path.dL_dq.transpose() * dq_);
      addActivation(d.dl_dActivation, activation_, si, fibre);
      for (const QuantityEffect& effect : effects_.muscles[i].fibre) {
        fibre[effect.column] += effect.factor * d.dl_dQuantity[effect.quantity];
      }
      forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
        fibre[effect.column] += effect.factor * d.dl_dMuscleTendonLength * gradient[0];
      });
    }
  }

  // One part of a step ----------------------------------------------------------------------------

  /// dt/dθ of a time of the tape; null: fixed.
  const RowVector* slopeOf(const StepTape& tape, std::size_t index) {
    const StepTape::Time& time = tape.times()[index];
    RowVector& slope = times_[index];
    if (slope.size()) widen(slope);
    if (time.law == StepTape::Time::Law::middle && slope.size() == 0) {
      const RowVector* a = slopeOf(tape, time.first);
      const RowVector* b = slopeOf(tape, time.second);
      if (a && b) slope = (*a + *b) / 2;
      if (a && !b) slope = *a / 2;
      if (!a && b) slope = *b / 2;
    }
    return slope.size() ? &slope : nullptr;
  }

  /// Makes room for every node whose hat has begun before t.
  void beginNodes(double t) {
    const std::vector<double>& times = nodes_.times;
    std::size_t begun = begunNodes_;
    while (begun < times.size() && times[begun == 0 ? 0 : begun - 1] < t) ++begun;
    if (begun == begunNodes_) return;
    constexpr std::size_t together = 8;  // rather than one by one
    begunNodes_ = std::min(times.size(), (begun + together - 1) / together * together);
    for (Rows* rows : {&dq_, &dp_, &forward_, &force_, &inertia_, &slope_}) widen(*rows);
    for (auto* rows : {&fibre_, &trialFibre_}) widen(*rows);
    if (excitation_.isSpread()) {
      for (auto* rows : {&activation_, &middle_}) widen(*rows);
    }
    for (RowVector* row : {&row_, &middleTime_, &unit_}) widen(*row);
  }
  template <class RowsOf>
  void widen(RowsOf& rows) const {
    const Index before = rows.cols();
    const Index columns = numParameters_ + 1 + static_cast<Index>(begunNodes_);
    if (before == columns) return;
    rows.conservativeResize(Eigen::NoChange, columns);
    rows.rightCols(columns - before).setZero();
  }

  /// Adds factor·∂a/∂θ of a muscle to a row with a column for every θ.
  template <class Row>
  void addActivation(double factor, const SensitivityMatrix& activation, Index muscle,
                     Row&& row) const {
    if (excitation_.isSpread()) {
      row += factor * activation.row(muscle);
      return;
    }
    const std::vector<Index>& columns = excitation_.columns();
    for (std::size_t j = 0; j < columns.size(); ++j) {
      row[columns[j]] += factor * activation(muscle, static_cast<Index>(j));
    }
  }

  /// A time that moves takes the activations with it: a column for every θ.
  void spreadActivation() {
    if (excitation_.isSpread()) return;
    const std::vector<Index>& columns = excitation_.columns();
    SensitivityMatrix all = SensitivityMatrix::Zero(numMuscles_, dq_.cols());
    for (std::size_t j = 0; j < columns.size(); ++j) {
      all.col(columns[j]) = activation_.col(static_cast<Index>(j));
    }
    middle_.setZero(numMuscles_, dq_.cols());
    activation_ = std::move(all);
    excitation_.spread();
  }

  void follow(const StepTape& tape, std::size_t i) {
    const StepTape::Part& part = tape.parts()[i];
    const StepTape::Time& end = tape.times()[part.end];
    beginNodes(end.value);
    const double t0 = tape.times()[part.begin].value;
    const RowVector* dt0 = slopeOf(tape, part.begin);
    const bool meets = end.law == StepTape::Time::Law::onSwitch;
    const RowVector* dt1 = meets ? &unit_ : slopeOf(tape, part.end);
    step(tape, i, t0, end.value, dt0, dt1);
    if (!meets) return;
    // dt/dθ = −(dq/dθ)/(dq/dt): the coordinate has its value at the switch whatever θ is
    const Index last = numParameters_;
    const int k = end.met->freeIndex;
    RowVector& dt = times_[part.end];
    dt = dq_.row(k) * (-1 / dq_(k, last));
    dt[last] = 0;
    for (auto* rows : {&dq_, &dp_}) addAlong(*rows, dt);
    for (auto* rows : {&fibre_, &activation_}) addAlong(*rows, dt);
  }

  /// Total derivatives from those at a held time, in the last column that in the time.
  template <class RowsOf>
  void addAlong(RowsOf& rows, const RowVector& dt) {
    for (Index r = 0; r < rows.rows(); ++r) {
      const double rate = rows(r, numParameters_);
      rows.row(r) += rate * dt;
      rows(r, numParameters_) = 0;
    }
  }

  void step(const StepTape& tape, std::size_t i, double t0, double t1, const RowVector* dt0,
            const RowVector* dt1) {
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
      spreadActivation();
      row_.setZero();
      if (dt1) row_ += *dt1;
      if (dt0) row_ -= *dt0;  // dh
      middleTime_ = row_ / 2;
      if (dt0) middleTime_ += *dt0;
    }

    // activations at the middle and at the end
    excitation_.advance(t0, tMiddle, dt0, timeMoves ? &middleTime_ : nullptr, tape.activation(i),
                        activation_, middle_);
    excitation_.advance(tMiddle, t1, timeMoves ? &middleTime_ : nullptr, dt1,
                        tape.middleActivation(i + 1), middle_, activation_);

    configuration_.moveTo(q_m);
    const InertiaJet<N>& inertia = configuration_.inertia();

    // skeleton: (M v) and L_q = ½ vᵀ∂M v − ∂V over the middle configuration and the speed
    Vector L_q = -inertia.dV;
    Matrix Mv_q = Matrix::Zero();
    Matrix L_qq = -inertia.d2V;
    Matrix L_qv = Matrix::Zero();
    if (!arm_.skeleton().hasConstantInertia()) {
      for (int k = 0; k < N; ++k) {
        const Vector M_k_v = inertia.dM[static_cast<std::size_t>(k)] * v;
        L_q[k] += v.dot(M_k_v) / 2;
        Mv_q.col(k) = M_k_v;
        L_qv.row(k) = M_k_v.transpose();
        for (int j = 0; j < N; ++j) {
          L_qq(k, j) += v.dot(inertia.d2M[static_cast<std::size_t>(pairIndex(k, j))] * v) / 2;
        }
      }
    }

    // passive coordinate forces
    Vector f = Vector::Zero();
    Matrix f_q = Matrix::Zero();
    Matrix f_v = Matrix::Zero();
    arm_.coordinateForces().template add<N>(q_m, v, f, f_q, f_v);
    force_.setZero();  // what of df does not go through dq′
    addPassiveForces(q_m, v);
    if (!options_.simulation.externalForce.empty()) {
      const ExternalForce::At external = options_.simulation.externalForce.at(tMiddle);
      f += external.value;
      if (timeMoves) force_ += external.slope * middleTime_;
    }
    addNodes(tMiddle);

    // muscles: dℓ′ = trialFibre + (V_L/2J) ∂ℓ·dq′
    Matrix f_end = Matrix::Zero();  // df through the fibres that dq′ moves
    for (std::size_t m = 0; m < arm_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const SchutteMuscle<double>& muscle = arm_.muscles()[m].muscle;
      const LengthJet<N>& path = configuration_.length(m);
      const double l_m = (l0[sm] + l1[sm]) / 2;
      const FibreRateDerivatives r = fibreRateDerivatives(muscle, activation[sm], l_m, path.length);
      const double perJ = 1 / (1 / h - r.dV_dFibreLength / 2);
      auto trial = trialFibre_.row(sm);
      const double half = r.dV_dMuscleTendonLength / 2 * perJ;
      trial = ((1 / h + r.dV_dFibreLength / 2) * perJ) * fibre_.row(sm) +
              (half * path.dL_dq[0]) * dq_.row(0);
      for (int k = 1; k < N; ++k) trial += (half * path.dL_dq[k]) * dq_.row(k);
      addActivation(r.dV_dActivation * perJ, middle_, sm, trial);
      if (timeMoves) trial += ((l1[sm] - l0[sm]) / (h * h) * perJ) * row_;
      addMuscleParameters(m, q_m, activation[sm], l_m, path, r, perJ, trial);

      f -= r.tendonForce * path.dL_dq;
      f_q.noalias() -= (r.dF_dMuscleTendonLength * path.dL_dq) * path.dL_dq.transpose();
      f_q -= r.tendonForce * path.d2L_dq2;
      const double G = r.dF_dFibreLength / 2;
      f_end.noalias() -= (G * half * path.dL_dq) * path.dL_dq.transpose();
      for (int k = 0; k < N; ++k) {
        force_.row(k) -= (G * path.dL_dq[k]) * (fibre_.row(sm) + trial);
      }
    }

    // linear in the ends: x_end = x_q/2 + x_v/h, x_begin = x_q/2 − x_v/h, x_h = −x_v v/h
    const Matrix& M = inertia.massMatrix;
    const Matrix residual_q = Mv_q - h / 2 * L_qq - share * f_q;
    const Matrix residual_v = M - h / 2 * L_qv - share * f_v;
    const Matrix momentum_q = Mv_q + h / 2 * L_qq + endShare * f_q;
    const Matrix momentum_v = M + h / 2 * L_qv + endShare * f_v;
    addInertia(v);

    // R: (∂R/∂q′ − …) dq′ = −(all the rest)
    const Matrix J = residual_q / 2 + residual_v / h - share * f_end;
    const Matrix perJ = J.inverse();
    const Matrix atBegin = residual_q / 2 - residual_v / h;
    forward_.noalias() = (-perJ * atBegin) * dq_;
    forward_.noalias() += perJ * dp_;
    forward_.noalias() += (share * perJ) * force_;
    if (changesInertia()) {
      forward_.noalias() -= perJ * inertia_;
      forward_.noalias() += (h / 2 * perJ) * slope_;
    }
    if (timeMoves) {
      const Vector inTime = -residual_v * v / h - L_q / 2 - share / h * f;
      forward_.noalias() -= (perJ * inTime) * row_;
    }

    // p′
    const Matrix endToEnd = momentum_q / 2 + momentum_v / h + endShare * f_end;
    const Matrix beginToEnd = momentum_q / 2 - momentum_v / h;
    dp_.noalias() = endToEnd * forward_;
    dp_.noalias() += beginToEnd * dq_;
    if (changesInertia()) dp_ += inertia_ + h / 2 * slope_;
    if (symmetric_) dp_ += endShare * force_;
    if (timeMoves) {
      const Vector inTime = -momentum_v * v / h + L_q / 2 + endShare / h * f;
      dp_.noalias() += inTime * row_;
    }

    // ℓ′ and q′
    for (std::size_t m = 0; m < arm_.numMuscles(); ++m) {
      const auto sm = static_cast<Index>(m);
      const LengthJet<N>& path = configuration_.length(m);
      auto fibre = fibre_.row(sm);
      fibre = trialFibre_.row(sm) + (through_[m] * path.dL_dq[0]) * forward_.row(0);
      for (int k = 1; k < N; ++k) fibre += (through_[m] * path.dL_dq[k]) * forward_.row(k);
    }
    dq_.swap(forward_);
  }

  /// ∂r/∂θ of one muscle: into its fibre's row and into the force on the skeleton.
  template <class Row>
  void addMuscleParameters(std::size_t m, const Vector& q, double activation, double l_m,
                           const LengthJet<N>& path, const FibreRateDerivatives& r, double perJ,
                           Row& trial) {
    through_.resize(arm_.numMuscles());
    through_[m] = r.dV_dMuscleTendonLength / 2 * perJ;
    const auto& effects = effects_.muscles[m];
    if (!effects.fibre.empty()) {
      const FibreParameterDerivatives d =
          fibreParameterDerivatives(arm_.muscles()[m].muscle, activation, l_m, path.length);
      for (const QuantityEffect& effect : effects.fibre) {
        trial[effect.column] += effect.factor * perJ * d.dV[effect.quantity];
        force_.col(effect.column) -= effect.factor * d.dF[effect.quantity] * path.dL_dq;
      }
    }
    forGeometry(m, q, [&](const QuantityEffect& effect, const auto& gradient) {
      trial[effect.column] += effect.factor * r.dV_dMuscleTendonLength * perJ * gradient[0];
      for (int k = 0; k < N; ++k) {
        force_(k, effect.column) -=
            effect.factor * (r.dF_dMuscleTendonLength * gradient[0] * path.dL_dq[k] +
                             r.tendonForce * gradient[1 + k]);
      }
    });
  }

  /// Calls use(effect, row of the gradient) for each geometric parameter of a muscle; the segments
  /// must be where q puts them.
  template <class Use>
  void forGeometry(std::size_t m, const Vector& q, const Use& use) {
    const auto& effects = effects_.muscles[m];
    if (!effects.hasGeometry()) return;
    PathGradient<N>& gradient = workspaces_[m];
    gradients_[m].template evaluate<N>(q, configuration_.motions().data(), gradient);
    for (const QuantityEffect& effect : effects.points) {
      use(effect,
          gradient.points[effect.quantity / 3].row(static_cast<Index>(effect.quantity % 3)));
    }
    for (const QuantityEffect& effect : effects.wraps) {
      use(effect, gradient.wraps[effect.quantity / 7].row(static_cast<Index>(effect.quantity % 7)));
    }
  }

  void addPassiveForces(const Vector& q, const Vector& v) {
    for (const auto& force : effects_.limitForces) {
      const auto d = parameterDerivatives(force.law, q[force.coordinate], v[force.coordinate]);
      force_(force.coordinate, force.effect.column) +=
          force.effect.factor * d[force.effect.quantity];
    }
    for (const auto& force : effects_.springForces) {
      const auto d = parameterDerivatives(force.law, q[force.coordinate], v[force.coordinate]);
      force_(force.coordinate, force.effect.column) +=
          force.effect.factor * d[force.effect.quantity];
    }
    for (const auto& force : effects_.expressions) {
      force_(force.coordinate, force.effect.column) +=
          force.effect.factor * force.law.parameterDerivative(force.effect.quantity,
                                                              q[force.coordinate],
                                                              v[force.coordinate]);
    }
  }

  /// ∂f/∂d of the nodes between which t lies.
  void addNodes(double t) {
    const std::vector<double>& times = nodes_.times;
    if (times.empty() || t < times.front() || t > times.back()) return;
    while (node_ + 2 < times.size() && times[node_ + 1] <= t) ++node_;
    while (node_ > 0 && times[node_] > t) --node_;
    const Index first = numParameters_ + 1 + static_cast<Index>(node_);
    const double w = (t - times[node_]) / (times[node_ + 1] - times[node_]);
    force_(nodes_.coordinate, first) += 1 - w;
    force_(nodes_.coordinate, first + 1) += w;
  }

  bool changesInertia() const { return !effects_.segments.empty() || !effects_.gravity.empty(); }

  /// inertia_ = ∂(M v)/∂θ and slope_ = ∂(½ vᵀ∂M v − ∂V)/∂θ, linear in the segments' moments:
  /// with Ẋ = Σ v_l ∂_lX, (M v)_k = tr(∂_kX P Ẋᵀ) and ½ vᵀ∂_kM v = tr(∂_kẊ P Ẋᵀ).
  void addInertia(const Vector& v) {
    if (!changesInertia()) return;  // both stay 0
    inertia_.setZero();
    slope_.setZero();
    for (const auto& effect : effects_.segments) {
      const RigidMotion<double, N>& X = configuration_.motions()[effect.segment];
      const auto along = [&](auto&& part) {
        Placement<double> sum{Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
        for (int l = 0; l < N; ++l) {
          const Placement<double>& X_l = part(l);
          sum.R += v[l] * X_l.R;
          sum.p += v[l] * X_l.p;
        }
        return sum;
      };
      const Placement<double> dX =
          along([&](int l) -> const auto& { return X.first[static_cast<std::size_t>(l)]; });
      for (int k = 0; k < N; ++k) {
        const Placement<double>& X_k = X.first[static_cast<std::size_t>(k)];
        const Placement<double> dX_k = along([&](int l) -> const auto& {
          return X.second[static_cast<std::size_t>(pairIndex(k, l))];
        });
        inertia_(k, effect.column) += detail::momentProduct(effect.change, X_k, dX);
        slope_(k, effect.column) += detail::momentProduct(effect.change, dX_k, dX) +
                                    arm_.skeleton().gravity().dot(X_k.R * effect.change.massMoment +
                                                                  X_k.p * effect.change.mass);
      }
    }
    for (const QuantityEffect& effect : effects_.gravity) {
      const auto axis = static_cast<Index>(effect.quantity);
      for (std::size_t s = 1; s < arm_.skeleton().numSegments(); ++s) {
        const Segment& segment = arm_.skeleton().segments()[s];
        for (int k = 0; k < N; ++k) {
          const Placement<double>& X_k =
              configuration_.motions()[s].first[static_cast<std::size_t>(k)];
          slope_(k, effect.column) += effect.factor * (X_k.R.row(axis).dot(segment.massMoment) +
                                                       X_k.p[axis] * segment.mass);
        }
      }
    }
  }

  // Output ----------------------------------------------------------------------------------------

  void record(Index row, SensitivityTrajectory& result) {
    const Trajectory& motion = result.motion;
    const Vector q = motion.q.col(row);
    const Vector qDot = motion.qDot.col(row);
    if (options_.muscles) {
      configuration_.moveTo(q);
    } else if (!arm_.skeleton().hasConstantInertia() || changesInertia()) {
      configuration_.moveSkeletonTo(q);
    }
    const InertiaJet<N>& inertia = configuration_.inertia();
    // q̇ = M⁻¹p
    addInertia(qDot);
    forward_ = dp_ - inertia_;
    if (!arm_.skeleton().hasConstantInertia()) {
      for (int k = 0; k < N; ++k) {
        forward_ -= (inertia.dM[static_cast<std::size_t>(k)] * qDot) * dq_.row(k);
      }
    }
    const Matrix perMass = inertia.massMatrix.inverse();
    force_.noalias() = perMass * forward_;
    for (int k = 0; k < N; ++k) {
      const auto sk = static_cast<std::size_t>(k);
      result.q[sk].row(row) = dq_.row(k).head(numParameters_);
      result.qDot[sk].row(row) = force_.row(k).head(numParameters_);
      if (nodes_.times.empty()) continue;
      const auto begun = static_cast<Index>(begunNodes_);
      result.qOfNodes[sk].row(row).head(begun) = dq_.row(k).tail(begun);
      result.qDotOfNodes[sk].row(row).head(begun) = force_.row(k).tail(begun);
    }
    if (!options_.muscles) return;
    for (std::size_t i = 0; i < arm_.numMuscles(); ++i) {
      const auto si = static_cast<Index>(i);
      const LengthJet<N>& path = configuration_.length(i);
      const double l = motion.fibreLength(si, row);
      const double activation = motion.activation(si, row);
      const FibreRateDerivatives r =
          fibreRateDerivatives(arm_.muscles()[i].muscle, activation, l, path.length);
      const FibreParameterDerivatives d =
          fibreParameterDerivatives(arm_.muscles()[i].muscle, activation, l, path.length);
      result.fibreLength[i].row(row) = fibre_.row(si).head(numParameters_);
      result.activation[i].row(row).setZero();
      if (excitation_.isSpread()) {
        result.activation[i].row(row) = activation_.row(si).head(numParameters_);
      } else {
        addActivation(1, activation_, si, result.activation[i].row(row));
      }
      auto force = result.tendonForce[i].row(row);
      force = (r.dF_dFibreLength * fibre_.row(si) +
               r.dF_dMuscleTendonLength * (path.dL_dq.transpose() * dq_))
                  .head(numParameters_);
      for (const QuantityEffect& effect : effects_.muscles[i].fibre) {
        force[effect.column] += effect.factor * d.dF[effect.quantity];
      }
      forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
        force[effect.column] += effect.factor * r.dF_dMuscleTendonLength * gradient[0];
      });
    }
  }

  const Arm& arm_;
  const ParameterEffects& effects_;
  const SensitivityOptions& options_;
  bool symmetric_;
  Index numParameters_;
  Index numMuscles_;
  const ExternalNodes& nodes_;
  std::size_t begunNodes_ = 0;  ///< have columns
  std::size_t node_ = 0;        ///< before the time reached
  ArmConfiguration<N> configuration_;
  ExcitationSensitivity excitation_;
  std::vector<PathGradients> gradients_;
  std::vector<PathGradient<N>> workspaces_;
  std::vector<double> through_;   ///< (V_L/2J) of each muscle
  std::vector<RowVector> times_;  ///< dt/dθ of the tape's times; empty: fixed
  Rows dq_, dp_, forward_, force_, inertia_, slope_;
  SensitivityMatrix fibre_, trialFibre_, activation_, middle_;
  RowVector row_, middleTime_, unit_;
};

}  // namespace bio::stepping
