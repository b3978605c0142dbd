#pragma once

// Rows of a run's sensitivities; not public.

#include "sensitivity/parameter_jacobian.h"
#include "sensitivity/reaction_slopes.h"
#include "simulation/coordinate_sums.h"

namespace bio::stepping {

/// Writes d(motion)/dθ row by row, as SensitivityTrajectory has it.
template <int N>
class SensitivityRecorder {
 public:
  using Index = Eigen::Index;
  using RowVector = Eigen::RowVectorXd;
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  using State = SensitivityState<N>;

  /// @param result  holds the motion already
  SensitivityRecorder(const MusculoskeletalSystem& arm, const SensitivityOptions& options,
                      const ExcitationSignal& driven, SystemConfiguration<N>& configuration,
                      DirectEffects<N>& direct, const SensitivityColumns& columns,
                      SensitivityTrajectory& result)
      : arm_(arm),
        muscles_(options.muscles || options.reactions),
        configuration_(configuration),
        direct_(direct),
        result_(result),
        rows_(static_cast<Index>(result.motion.time.size())) {
    const auto room = [&](std::size_t count) {
      return std::vector<SensitivityMatrix>(count,
                                            SensitivityMatrix(rows_, columns.numParameters()));
    };
    const auto n = static_cast<std::size_t>(countOf<N>(arm));
    result.q = room(n);
    result.qDot = room(n);
    if (muscles_) {
      result.fibreLength = result.activation = result.tendonForce = room(arm.numMuscles());
      recordThickness(columns.numParameters());
    }
    const auto numNodes = static_cast<Index>(columns.nodes().times.size());
    if (numNodes > 0) {
      result.qOfNodes.assign(n, SensitivityMatrix::Zero(rows_, numNodes));
      result.qDotOfNodes = result.qOfNodes;
    }
    if (options.reactions && !arm.prescribed().empty()) {
      result.reaction.resize(n);
      for (const int k : arm.prescribed()) {
        result.reaction[static_cast<std::size_t>(k)].resize(rows_, columns.numParameters());
      }
      reactions_.emplace(arm, options.simulation, driven, configuration, direct);
    }
  }

  /// The next row of the motion, if there is one.
  void add(const State& state) {
    if (row_ == rows_) return;
    const Vector q = result_.motion.q.col(row_);
    const Vector qDot = result_.motion.qDot.col(row_);
    if (muscles_) {
      configuration_.moveTo(q);
    } else if (!arm_.skeleton().hasConstantInertia() || direct_.changesInertia()) {
      configuration_.moveSkeletonTo(q);
    }
    addCoordinates(qDot, state);
    for (std::size_t i = 0; muscles_ && i < arm_.numMuscles(); ++i) {
      if (arm_.muscles()[i].muscle.hasFibreState()) {
        addMuscle(i, q, state);
      } else {
        addRigid(i, q, qDot, state);
      }
    }
    if (reactions_) reactions_->add(row_, state, speed_, result_);
    ++row_;
  }

 private:
  void recordThickness(Index parameters) {
    for (std::size_t i = 0; i < arm_.numMuscles(); ++i) {
      const PerMuscleNumber d = arm_.muscles()[i].muscle.thicknessInNumbers();
      RowVector& row = result_.thickness.emplace_back(RowVector::Zero(parameters));
      for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
        row[effect.column] += effect.factor * d[effect.quantity];
      }
    }
  }

  /// q̇ = M⁻¹p
  void addCoordinates(const Vector& qDot, const State& state) {
    const EnergyDerivatives<N>& energy = configuration_.energy(qDot);
    direct_.computeInertia(qDot);
    momentum_ = state.dp - direct_.momentum();
    if (!arm_.skeleton().hasConstantInertia()) {
      for (Index k = 0; k < state.dq.rows(); ++k) {
        momentum_ -= energy.T_vq.col(k) * state.dq.row(k);
      }
    }
    const Matrix perMass = inverseMass(energy.T_vv);
    speed_.noalias() = perMass * momentum_;
    const Index parameters = state.columns.numParameters();
    for (int k = 0; k < countOf<N>(arm_); ++k) {
      const auto sk = static_cast<std::size_t>(k);
      result_.q[sk].row(row_) = state.dq.row(k).head(parameters);
      result_.qDot[sk].row(row_) = speed_.row(k).head(parameters);
      if (state.columns.nodes().times.empty()) continue;
      const Index begun = state.columns.numBegun();
      result_.qOfNodes[sk].row(row_).head(begun) = state.dq.row(k).tail(begun);
      result_.qDotOfNodes[sk].row(row_).head(begun) = speed_.row(k).tail(begun);
    }
  }

  /// M⁻¹; of prescribed coordinates the speed is given, and its derivative is 0.
  Matrix inverseMass(const Matrix& M) {
    if (arm_.prescribed().empty()) return M.inverse();
    Matrix reduced = M;
    decouple(arm_.prescribed(), reduced);
    for (const int k : arm_.prescribed()) momentum_.row(k).setZero();
    return reduced.inverse();
  }

  void addMuscle(std::size_t i, const Vector& q, const State& state) {
    const auto si = static_cast<Index>(i);
    const Index parameters = state.columns.numParameters();
    const SimulatedMuscle& muscle = arm_.muscles()[i].muscle;
    const LengthJet<N>& path = configuration_.length(i);
    const double l = result_.motion.fibreLength(si, row_);
    const double activation = result_.motion.activation(si, row_);
    SchuttePieces unknown;
    const FibreRateDerivatives r = muscle.rate(activation, l, path.length, unknown);
    const SimulatedMuscle::InNumbers d = muscle.inNumbers(activation, l, path.length, 0, unknown);
    result_.fibreLength[i].row(row_) = state.fibre.row(si).head(parameters);
    state.activation.record(si, result_.activation[i].row(row_));
    auto force = result_.tendonForce[i].row(row_);
    force = (r.dF_dFibreLength * state.fibre.row(si) +
             r.dF_dMuscleTendonLength * (path.dL_dq.transpose() * state.dq))
                .head(parameters);
    for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
      force[effect.column] += effect.factor * d.dF[effect.quantity];
    }
    direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
      force[effect.column] += effect.factor * r.dF_dMuscleTendonLength * gradient[0];
    });
  }

  /// With a rigid tendon fibre length and force follow from the row.
  void addRigid(std::size_t i, const Vector& q, const Vector& qDot, const State& state) {
    const auto si = static_cast<Index>(i);
    const Index parameters = state.columns.numParameters();
    const SimulatedMuscle& muscle = arm_.muscles()[i].muscle;
    const LengthJet<N>& path = configuration_.length(i);
    const double activation = result_.motion.activation(si, row_);
    const double speed = path.dL_dq.dot(qDot);
    const muscles::RigidRate<double> r = muscle.rigidRate(activation, path.length, speed);
    const PerMuscleNumber d = muscle.rigidInNumbers(activation, path.length, speed);
    const SimulatedMuscle::RestSlopes l = muscle.restSlopes(
        activation, path.length, {StaticEquilibrium::Why::found, r.fibreLength, r.tendonForce, 1});
    state.activation.record(si, result_.activation[i].row(row_));
    const RowVector length = path.dL_dq.transpose() * state.dq;
    auto fibre = result_.fibreLength[i].row(row_);
    auto force = result_.tendonForce[i].row(row_);
    fibre = l.dl_dPathLength * length.head(parameters);
    Vector F_q = r.dF_dPathLength * path.dL_dq;
    addSecondTimes<N>(F_q, r.dF_dPathSpeed, path, qDot);
    force = (F_q.transpose() * state.dq + r.dF_dPathSpeed * (path.dL_dq.transpose() * speed_))
                .head(parameters);
    force += r.dF_dActivation * result_.activation[i].row(row_);
    for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
      fibre[effect.column] += effect.factor * l.dl_dNumber[effect.quantity];
      force[effect.column] += effect.factor * d[effect.quantity];
    }
    direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
      double change = r.dF_dPathLength * gradient[0];
      forEachMoved<N>(
          path, [&](int k, int slot) { change += r.dF_dPathSpeed * gradient[1 + slot] * qDot[k]; });
      fibre[effect.column] += effect.factor * l.dl_dPathLength * gradient[0];
      force[effect.column] += effect.factor * change;
    });
  }

  const MusculoskeletalSystem& arm_;
  bool muscles_;
  SystemConfiguration<N>& configuration_;
  DirectEffects<N>& direct_;
  SensitivityTrajectory& result_;
  Index rows_, row_ = 0;
  typename State::Rows momentum_, speed_;
  std::optional<ReactionSlopes<N>> reactions_;
};

}  // namespace bio::stepping
