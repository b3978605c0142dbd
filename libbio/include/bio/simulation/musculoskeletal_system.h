#pragma once

#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bio/forces/body_forces.h"
#include "bio/forces/coordinate_force.h"
#include "bio/model/model.h"
#include "bio/muscle/activation_dynamics.h"
#include "bio/muscle/simulated_muscle.h"
#include "bio/path/path.h"
#include "bio/path/tree_path.h"
#include "bio/skeleton/skeleton.h"
#include "bio/skeleton/tree_energy.h"

namespace bio {

class PostureSamples;

struct SystemOptions {
  SkeletonOptions skeleton;  ///< free coordinates, and values of the locked ones
  std::vector<std::string> wrapAsCylinder =
      {};                      ///< ellipsoids with two equal semi-axes to treat as cylinders
  SchutteOptions muscle = {};  ///< of Schutte's class: activation floor, negative forces
  bool tabulatePaths = false;  ///< MusclePath::tabulate; worthwhile after a few simulations
  /// Free coordinates whose motion is given (SimulationOptions::prescribed): by a
  /// trial, or by the model's own function of time (courseOf()).
  std::vector<std::string> prescribed = {};
  int threads = 1;  ///< that find the taut paths of different muscles; 0: all cores
};

/// One muscle ready to be simulated.
struct SystemMuscle {
  std::string name;
  SimulatedMuscle muscle;
  ActivationDynamics activation;
  MusclePath path;
};

/// A marker of the model, in the segment that carries it.
struct SystemMarker {
  std::string name;  ///< BODY.MARKER
  std::size_t segment = 0;
  Eigen::Vector3d p_S;  ///< [m]
};

/// A string without state, ready to be simulated.
struct SystemElasticPath {
  std::string name;
  ElasticPathLaw law;
  MusclePath path;
};

/// A model compiled for simulation: the skeleton with its free coordinates, the muscles that these
/// move, and the passive coordinate forces. A muscle whose path moves over a surface without an
/// exact geodesic (UnsupportedWrap) is left out with a warning. Constant: functions take the state
/// as an argument.
class MusculoskeletalSystem {
 public:
  /// @throws std::invalid_argument what Skeleton and MusclePath throw, non-physical muscle
  ///   parameters, a moving muscle of a class that is not known, free coordinates that move no
  ///   mass, a moving body with a negative principal moment of inertia, a prescribed coordinate
  ///   that is not among the free ones or is named twice
  MusculoskeletalSystem(const Model& model, const SystemOptions& options);

  /// The system of a model that differs from that of another system in numerical values only, made
  /// faster: paths and their tables are taken from `like`, except those of the muscles named, which
  /// get no tables. Its warnings are not repeated.
  /// @param like    made with the same options
  /// @param shaped muscles whose path points or wrap objects differ
  MusculoskeletalSystem(const Model& model, const SystemOptions& options,
                        const MusculoskeletalSystem& like, const std::vector<std::string>& shaped);

  const Skeleton& skeleton() const { return skeleton_; }
  /// Free indices of the prescribed coordinates, rising.
  const std::vector<int>& prescribed() const { return prescribed_; }
  bool isPrescribed(int coordinate) const;
  /// The model's own function of time of a prescribed coordinate; null: it has none.
  const Function* courseOf(int coordinate) const;
  /// This system with the motion of every coordinate given by SimulationOptions::prescribed.
  MusculoskeletalSystem withAllPrescribed() &&;

  const CoordinateForces& coordinateForces() const { return coordinateForces_; }
  const std::vector<SystemMuscle>& muscles() const { return muscles_; }
  std::size_t numMuscles() const { return muscles_.size(); }
  const std::vector<SystemMarker>& markers() const { return markers_; }

  /// Loads, springs between points, bushings.
  const BodyForces& bodyForces() const { return bodyForces_; }
  /// Ligaments and path springs.
  const std::vector<SystemElasticPath>& elasticPaths() const { return elasticPaths_; }
  /// Actuators on a free coordinate.
  const std::vector<CoordinateActuator>& actuators() const { return actuators_; }
  /// The muscles' paths, then the elastic ones.
  std::size_t numPaths() const { return muscles_.size() + elasticPaths_.size(); }
  const MusclePath& path(std::size_t i) const {
    return i < muscles_.size() ? muscles_[i].path : elasticPaths_[i - muscles_.size()].path;
  }

  /// The skeleton's tree with the moving points of the paths; null: Skeleton::tree() is.
  const ArticulatedTree* tree() const { return tree_.get(); }
  /// The path of this index, as for path(), over tree().
  const TreePath& treePath(std::size_t path) const { return treePaths_[path]; }

  /// Coordinate values at which a path gains or loses conditional points, each listed once.
  const std::vector<PathSwitch>& switches() const { return switches_; }

  /// Some coordinates move no mass together in the default posture, though they do in others: a
  /// motion must start elsewhere (Y-Z-Y angles at Z = 0).
  bool isSingularInDefaultPosture() const { return isSingularInDefaultPosture_; }

  /// One line each: muscles left out because they cannot be simulated, unusual locked values, paths
  /// without length, paths that use one of several wrap objects touched at once.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// One line each: muscles left out because no free coordinate moves them, spans treated as
  /// constant, wrap objects that no path reaches.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  MusculoskeletalSystem(const Model& model, const SystemOptions& options,
                        const MusculoskeletalSystem* like, const std::vector<std::string>& shaped);
  /// The path that can be reused; null: it must be compiled.
  const MusclePath* pathOf(const std::string& muscle) const;
  void addElasticPaths(const Model& model, const SystemOptions& options,
                       const MusculoskeletalSystem* like, PostureSamples& postures);
  void addSwitches(const MusclePath& path);
  /// All paths over tree_, where the skeleton has a tree.
  void addTreePaths(const Model& model);

  Skeleton skeleton_;
  std::vector<int> prescribed_;
  std::map<int, Function> courses_;  ///< the model's, by free index
  CoordinateForces coordinateForces_;
  BodyForces bodyForces_;
  std::vector<SystemElasticPath> elasticPaths_;
  std::vector<CoordinateActuator> actuators_;
  std::vector<std::unique_ptr<const SchutteCurves>> curves_;
  std::vector<std::unique_ptr<const muscles::AnyMuscle>> others_;  ///< of classes but Schutte's
  std::vector<SystemMuscle> muscles_;
  std::vector<SystemMarker> markers_;
  std::unique_ptr<ArticulatedTree> tree_;
  std::vector<TreePath> treePaths_;
  std::vector<PathSwitch> switches_;
  bool isSingularInDefaultPosture_ = false;
  std::vector<std::string> notes_;
  std::vector<std::string> warnings_;
};

/// All quantities that depend only on the configuration, for N free coordinates: segment
/// placements, inertia and gravity, muscle–tendon lengths, each with first and second derivatives.
/// A workspace: allocates when constructed, never when moved.
template <int N>
class SystemConfiguration {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  explicit SystemConfiguration(const MusculoskeletalSystem& system)
      : system_(&system), motions_(system.skeleton().numSegments()), lengths_(system.numPaths()) {
    energy_.T_q.setZero();
    energy_.T_vq.setZero();
    energy_.T_qq.setZero();
  }

  /// A path without a taut string there has the length NaN (stepping::describeLostPath names it).
  void moveTo(const Vector& q) {
    moveSkeletonTo(q);
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      try {
        for (; i < lengths_.size(); ++i) {
          lengths_[i] =
              system_->path(i).template length<N>(q, motions_.data(), holds_ ? &held_ : nullptr);
        }
      } catch (const std::domain_error&) {
        lengths_[i].length = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  /// Fixes the active conditional points to those of this configuration, for methods whose trial
  /// steps may cross a switch.
  void holdConditions(const Vector& at) {
    held_ = at;
    holds_ = true;
  }

  /// Does not update the lengths.
  void moveSkeletonTo(const Vector& q) {
    system_->skeleton().template motions<double, N>(q, motions_.data());
    inertia_ = system_->skeleton().template inertia<N>(q, motions_.data());
  }

  /// Lengths and inertia at q + d by their Taylor polynomials at q, up to the derivatives
  /// available: lengths, M and V lack terms of third order in d, and ∂ℓ, ∂M and ∂V terms of second
  /// order. The placements are not updated.
  void shift(const Vector& d) {
    for (LengthJet<N>& path : lengths_) {
      const Vector change = path.d2L_dq2 * d;
      path.length += d.dot(path.dL_dq + change / 2);
      path.dL_dq += change;
    }
    const Vector change = inertia_.d2V * d;
    inertia_.potential += d.dot(inertia_.dV + change / 2);
    inertia_.dV += change;
    if (system_->skeleton().hasConstantInertia()) return;
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
  const Eigen::Matrix<double, N, N>& massMatrix() const { return inertia_.massMatrix; }
  double potential() const { return inertia_.potential; }

  /// Energy derivatives that a step needs at speed v. Where M is constant, its derivatives stay 0.
  const EnergyDerivatives<N>& energy(const Vector& v) {
    EnergyDerivatives<N>& e = energy_;
    e.T_vv = inertia_.massMatrix;
    e.T_v.noalias() = inertia_.massMatrix * v;
    e.V_q = inertia_.dV;
    e.V_qq = inertia_.d2V;
    if (system_->skeleton().hasConstantInertia()) return e;
    for (int k = 0; k < N; ++k) {
      const Vector M_k_v = inertia_.dM[static_cast<std::size_t>(k)] * v;
      e.T_q[k] = v.dot(M_k_v) / 2;
      e.T_vq.col(k) = M_k_v;
      for (int j = 0; j < N; ++j) {
        e.T_qq(k, j) = v.dot(inertia_.d2M[static_cast<std::size_t>(pairIndex(k, j))] * v) / 2;
      }
    }
    return e;
  }

  /// Length of MusculoskeletalSystem::path(i): the muscles come first.
  const LengthJet<N>& length(std::size_t i) const { return lengths_[i]; }

 private:
  const MusculoskeletalSystem* system_;
  std::vector<RigidMotion<double, N>> motions_;
  InertiaJet<N> inertia_;
  EnergyDerivatives<N> energy_;
  std::vector<LengthJet<N>> lengths_;
  Vector held_;
  bool holds_ = false;
};

}  // namespace bio

#include "bio/simulation/tree_configuration.h"
