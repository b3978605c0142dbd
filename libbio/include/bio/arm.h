#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bio/activation.h"
#include "bio/coordinate_force.h"
#include "bio/model.h"
#include "bio/path.h"
#include "bio/schutte_muscle.h"
#include "bio/skeleton.h"

namespace bio {

struct ArmOptions {
  SkeletonOptions skeleton;  ///< which coordinates are free, where the others are held
  std::vector<std::string>
      wrapAsCylinder;          ///< ellipsoids with two equal semi-axes to take as cylinders
  SchutteOptions muscle;       ///< activation floor, treatment of negative forces
  bool tabulatePaths = false;  ///< MusclePath::tabulate; pays after a few simulations
};

/// One muscle ready to be simulated.
struct ArmMuscle {
  std::string name;
  SchutteMuscle<double> muscle;
  SchutteActivation<double> activation;
  MusclePath path;
};

/// A model compiled for simulation: the skeleton that the free coordinates leave, the muscles that
/// they move, and the passive coordinate forces. A muscle whose path moves over a surface without
/// an exact geodesic (UnsupportedWrap) is left out with a warning. Constant; state is passed to it.
class Arm {
 public:
  /// @throws std::invalid_argument what Skeleton and MusclePath throw, non-physical muscle
  ///   parameters, a moving muscle of a class other than Schutte's, free coordinates that move no
  ///   mass, a moving body with a negative principal moment of inertia
  Arm(const Model& model, const ArmOptions& options);

  /// The same, quicker, for a model that differs from another arm's in numbers alone: paths are
  /// taken from that arm, tables and all, but for those of the muscles named, which get no tables.
  /// Its remarks are not repeated.
  /// @param like    made with the same options
  /// @param shaped  muscles one of whose path points or wrap objects differs
  Arm(const Model& model, const ArmOptions& options, const Arm& like,
      const std::vector<std::string>& shaped);

  const Skeleton& skeleton() const { return skeleton_; }
  const CoordinateForces& coordinateForces() const { return coordinateForces_; }
  const std::vector<ArmMuscle>& muscles() const { return muscles_; }
  std::size_t numMuscles() const { return muscles_.size(); }

  /// Where a path of this arm gains or loses conditional points, each once.
  const std::vector<PathSwitch>& switches() const { return switches_; }

  /// One line each: muscles that move but cannot be simulated and are left out, odd locks, paths
  /// without length and those that heed one wrap object of several.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// One line each: muscles left out because nothing moves them, spans taken as constant, wraps out
  /// of reach.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Arm(const Model& model, const ArmOptions& options, const Arm* like,
      const std::vector<std::string>& shaped);
  /// The path that may be taken as it is; null: compile it.
  const MusclePath* pathOf(const std::string& muscle) const;

  Skeleton skeleton_;
  CoordinateForces coordinateForces_;
  std::vector<std::unique_ptr<const SchutteCurves>> curves_;
  std::vector<ArmMuscle> muscles_;
  std::vector<PathSwitch> switches_;
  std::vector<std::string> notes_;
  std::vector<std::string> warnings_;
};

/// Everything about an arm that depends on the configuration alone, for N free coordinates: segment
/// placements, inertia and gravity, muscle–tendon lengths, each with first and second derivatives.
/// A workspace: allocates when made, never when moved.
template <int N>
class ArmConfiguration {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit ArmConfiguration(const Arm& arm)
      : arm_(&arm), motions_(arm.skeleton().numSegments()), lengths_(arm.numMuscles()) {}

  void moveTo(const Vector& q) {
    moveSkeletonTo(q);
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      lengths_[i] =
          arm_->muscles()[i].path.template length<N>(q, motions_.data(), holds_ ? &held_ : nullptr);
    }
  }

  /// From now on the paths' conditional points are those of this configuration, wherever the arm
  /// moves: for a method whose trial steps may reach beyond one of the arm's switches.
  void holdConditions(const Vector& at) {
    held_ = at;
    holds_ = true;
  }

  /// Leaves the lengths where they are.
  void moveSkeletonTo(const Vector& q) {
    arm_->skeleton().template motions<double, N>(q, motions_.data());
    inertia_ = arm_->skeleton().template inertia<N>(q, motions_.data());
  }

  /// Lengths and inertia at q + d by their Taylor polynomials at q, as far as their derivatives are
  /// known: lengths, M and V lack what is of third order in d, ∂ℓ, ∂M and ∂V what is of second.
  /// The placements stay where they are.
  void shift(const Vector& d) {
    for (LengthJet<N>& path : lengths_) {
      const Vector change = path.d2L_dq2 * d;
      path.length += d.dot(path.dL_dq + change / 2);
      path.dL_dq += change;
    }
    const Vector change = inertia_.d2V * d;
    inertia_.potential += d.dot(inertia_.dV + change / 2);
    inertia_.dV += change;
    if (arm_->skeleton().hasConstantInertia()) return;
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        const auto& bend = inertia_.d2M[static_cast<std::size_t>(pairIndex(i, j))];
        inertia_.massMatrix +=
            d[i] * (inertia_.dM[static_cast<std::size_t>(i)] / N + d[j] / 2 * bend);
      }
    }
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) {
        inertia_.dM[static_cast<std::size_t>(i)] +=
            d[j] * inertia_.d2M[static_cast<std::size_t>(pairIndex(i, j))];
      }
    }
  }

  const std::vector<RigidMotion<double, N>>& motions() const { return motions_; }
  const InertiaJet<N>& inertia() const { return inertia_; }
  const LengthJet<N>& length(std::size_t muscle) const { return lengths_[muscle]; }

 private:
  const Arm* arm_;
  std::vector<RigidMotion<double, N>> motions_;
  InertiaJet<N> inertia_;
  std::vector<LengthJet<N>> lengths_;
  Vector held_;
  bool holds_ = false;
};

}  // namespace bio
