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
  SensitivityRecorder(const MusculoskeletalSystem& system, const SensitivityOptions& options,
                      const ExcitationSignal& driven, SystemConfiguration<N>& configuration,
                      DirectEffects<N>& direct, const SensitivityColumns& columns,
                      SensitivityTrajectory& result)
      : system_(system),
        muscles_(options.muscles || options.reactions),
        configuration_(configuration),
        direct_(direct),
        result_(result),
        rows_(static_cast<Index>(result.motion.time.size())) {
    const auto room = [&](std::size_t count) {
      return std::vector<SensitivityMatrix>(count, SensitivityMatrix(rows_, columns.numRecorded()));
    };
    const auto n = static_cast<std::size_t>(countOf<N>(system));
    result.q = room(n);
    result.qDot = room(n);
    if (muscles_) {
      result.fibreLength = result.activation = result.tendonForce = room(system.numMuscles());
      recordThickness(columns.numRecorded());
    }
    if (options.reactions && !system.prescribed().empty()) {
      result.reaction.resize(n);
      for (const int k : system.prescribed()) {
        result.reaction[static_cast<std::size_t>(k)].resize(rows_, columns.numRecorded());
      }
      reactions_.emplace(system, options.simulation, driven, configuration, direct);
    }
  }

  /// The next row of the motion, if there is one.
  void add(const State& state) {
    if (row_ == rows_) return;
    const Vector q = result_.motion.q.col(row_);
    const Vector qDot = result_.motion.qDot.col(row_);
    if (muscles_) {
      configuration_.moveTo(q);
    } else if (!system_.skeleton().hasConstantInertia() || direct_.changesInertia()) {
      configuration_.moveSkeletonTo(q);
    }
    addCoordinates(qDot, state);
    if (muscles_) forces_.resize(static_cast<Index>(system_.numMuscles()), state.columns.count());
    for (std::size_t i = 0; muscles_ && i < system_.numMuscles(); ++i) {
      if (system_.muscles()[i].muscle.hasFibreState()) {
        addMuscle(i, q, state);
      } else {
        addRigid(i, q, qDot, state);
      }
    }
    if (reactions_) reactions_->add(row_, state, speed_, forces_, result_);
    ++row_;
  }

 private:
  void recordThickness(Index columns) {
    for (std::size_t i = 0; i < system_.numMuscles(); ++i) {
      const PerMuscleNumber d = system_.muscles()[i].muscle.thicknessInNumbers();
      RowVector& row = result_.thickness.emplace_back(RowVector::Zero(columns));
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
    if (!system_.skeleton().hasConstantInertia()) {
      for (Index k = 0; k < state.dq.rows(); ++k) {
        momentum_ -= energy.T_vq.col(k) * state.dq.row(k);
      }
    }
    const Matrix perMass = inverseMass(energy.T_vv);
    speed_.noalias() = perMass * momentum_;
    for (int k = 0; k < countOf<N>(system_); ++k) {
      const auto sk = static_cast<std::size_t>(k);
      state.columns.record(state.dq.row(k), result_.q[sk].row(row_));
      state.columns.record(speed_.row(k), result_.qDot[sk].row(row_));
    }
  }

  /// M⁻¹; of prescribed coordinates the speed is given, and its derivative is 0.
  Matrix inverseMass(const Matrix& M) {
    if (system_.prescribed().empty()) return M.inverse();
    Matrix reduced = M;
    decouple(system_.prescribed(), reduced);
    for (const int k : system_.prescribed()) momentum_.row(k).setZero();
    return reduced.inverse();
  }

  void addMuscle(std::size_t i, const Vector& q, const State& state) {
    const auto si = static_cast<Index>(i);
    const SimulatedMuscle& muscle = system_.muscles()[i].muscle;
    const LengthJet<N>& path = configuration_.length(i);
    const double l = result_.motion.fibreLength(si, row_);
    const double activation = result_.motion.activation(si, row_);
    SchuttePieces unknown;
    const FibreRateDerivatives r = muscle.rate(activation, l, path.length, unknown);
    const SimulatedMuscle::InNumbers d = muscle.inNumbers(activation, l, path.length, 0, unknown);
    state.columns.record(state.fibre.row(si), result_.fibreLength[i].row(row_));
    recordActivation(i, state);
    auto force = forces_.row(si);
    force = r.dF_dFibreLength * state.fibre.row(si) +
            r.dF_dMuscleTendonLength * (path.dL_dq.transpose() * state.dq);
    for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
      force[effect.column] += effect.factor * d.dF[effect.quantity];
    }
    direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
      force[effect.column] += effect.factor * r.dF_dMuscleTendonLength * gradient[0];
    });
    state.columns.record(force, result_.tendonForce[i].row(row_));
  }

  void recordActivation(std::size_t i, const State& state) {
    activation_.resize(state.columns.count());
    state.activation.record(static_cast<Index>(i), activation_);
    state.columns.record(activation_, result_.activation[i].row(row_));
  }

  /// With a rigid tendon fibre length and force follow from the row.
  void addRigid(std::size_t i, const Vector& q, const Vector& qDot, const State& state) {
    const auto si = static_cast<Index>(i);
    const SimulatedMuscle& muscle = system_.muscles()[i].muscle;
    const LengthJet<N>& path = configuration_.length(i);
    const double activation = result_.motion.activation(si, row_);
    const double speed = path.dL_dq.dot(qDot);
    const muscles::RigidRate<double> r = muscle.rigidRate(activation, path.length, speed);
    const PerMuscleNumber d = muscle.rigidInNumbers(activation, path.length, speed);
    const SimulatedMuscle::RestSlopes l = muscle.restSlopes(
        activation, path.length, {StaticEquilibrium::Why::found, r.fibreLength, r.tendonForce, 1});
    recordActivation(i, state);
    fibre_.noalias() = l.dl_dPathLength * (path.dL_dq.transpose() * state.dq);
    auto force = forces_.row(si);
    Vector F_q = r.dF_dPathLength * path.dL_dq;
    addSecondTimes<N>(F_q, r.dF_dPathSpeed, path, qDot);
    force = F_q.transpose() * state.dq + r.dF_dPathSpeed * (path.dL_dq.transpose() * speed_);
    force += r.dF_dActivation * activation_;
    for (const QuantityEffect& effect : direct_.effects().muscles[i].fibre) {
      fibre_[effect.column] += effect.factor * l.dl_dNumber[effect.quantity];
      force[effect.column] += effect.factor * d[effect.quantity];
    }
    direct_.forGeometry(i, q, [&](const QuantityEffect& effect, const auto& gradient) {
      double change = r.dF_dPathLength * gradient[0];
      forEachMoved<N>(
          path, [&](int k, int slot) { change += r.dF_dPathSpeed * gradient[1 + slot] * qDot[k]; });
      fibre_[effect.column] += effect.factor * l.dl_dPathLength * gradient[0];
      force[effect.column] += effect.factor * change;
    });
    state.columns.record(fibre_, result_.fibreLength[i].row(row_));
    state.columns.record(force, result_.tendonForce[i].row(row_));
  }

  const MusculoskeletalSystem& system_;
  bool muscles_;
  SystemConfiguration<N>& configuration_;
  DirectEffects<N>& direct_;
  SensitivityTrajectory& result_;
  Index rows_, row_ = 0;
  typename State::Rows momentum_, speed_;
  SensitivityMatrix forces_;  ///< of the tendons at the row
  RowVector activation_, fibre_;
  std::optional<ReactionSlopes<N>> reactions_;
};

}  // namespace bio::stepping
