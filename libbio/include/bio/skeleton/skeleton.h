#pragma once

#include <Eigen/Dense>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/muscle/curves/curves.h"
#include "bio/skeleton/rigid_motion.h"

namespace bio {
class ArticulatedTree;
namespace detail {
template <class T>
struct CurveJet;
}

/// The placement of a frame in its parent: R = R_x(o_x) R_y(o_y) R_z(o_z), as OpenSim orients
/// frames.
Placement<double> placementOf(const FramePlacement& frame);

/// Free and locked coordinates of a skeleton. Every coordinate that is neither named in
/// `freeCoordinates` nor coupled to one of them is removed: its joint axis becomes part of a rigid
/// segment.
struct SkeletonOptions {
  std::vector<std::string> freeCoordinates;         ///< order = order of q; at least one
  std::map<std::string, double> lockedValues = {};  ///< overrides defaults [rad] or [m]
  /// Spatial algebra (articulated_tree.h) for few coordinates, too; more than
  /// maxFixedCoordinates always have it.
  bool asTree = false;
};

/// A line for each coordinate that is locked outside its range by more than 1° or 1 mm, usually
/// because an angle was given in degrees.
std::vector<std::string> lockRemarks(const Model& model, const SkeletonOptions& options);

class Skeleton;

/// "elbow_flexion = 34 deg, slide = 0.01 m": the free coordinates' values.
std::string describePosture(const Skeleton& skeleton, const Eigen::VectorXd& q);

/// Bodies that do not move relative to each other, as one rigid body.
struct Segment {
  std::string name;  ///< of its first body; "ground" for segment 0
  double mass = 0;   ///< [kg]
  Eigen::Vector3d massMoment = Eigen::Vector3d::Zero();  ///< Σ m·r [kg m] in the segment frame
  Eigen::Matrix3d secondMoment =
      Eigen::Matrix3d::Zero();  ///< Σ m·r rᵀ [kg m²] in the segment frame
};

/// f(x) = x
inline Function identityFunction() {
  return Function{1, LinearFunction{1, 0}};
}

/// Up to so many segments and free coordinates are simulated by code of fixed size; what has more
/// is an articulated tree, which is several times faster (docs/decisions/057-articulated-trees.md).
constexpr std::size_t maxFixedSegments = 24;
constexpr int maxFixedCoordinates = 1;

/// The segment of a body and its fixed placement there.
struct BodyPlacement {
  std::size_t segment = 0;
  Placement<double> X_SB;  ///< body in the segment frame
};

/// Kinetic and potential quantities at one configuration of N free coordinates:
/// M = mass matrix, ∂M/∂q_k, ∂²M/∂q_k∂q_l, V = potential energy of gravity with gradient and
/// Hessian.
template <int N>
struct InertiaJet {
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;
  Matrix massMatrix;                    ///< M
  std::array<Matrix, N> dM;             ///< ∂M/∂q_k
  std::array<Matrix, numPairs(N)> d2M;  ///< ∂²M/∂q_k∂q_l
  double potential = 0;                 ///< V = −Σ m g·r [J]
  Vector dV;                            ///< ∂V/∂q
  Matrix d2V;                           ///< ∂²V/∂q²
};

/// The moving part of a model: rigid segments, and their joint motions by the free coordinates.
///
/// A joint motion is a product of elementary turns and shifts, R(axis, f(q_k)) or axis·f(q_k); the
/// placement of each segment and its derivatives follow from the product rule, exactly. With
/// P = [Σ m r rᵀ, Σ m r; ·, Σ m] the second moments of a segment and X its 4×4 placement,
///     M_kl = Σ tr(∂_kX P ∂_lXᵀ),   V = −Σ g·(R Σ m r + p Σ m)
/// (equivalent to the usual ½ m|ċ|² + ½ ωᵀJω; no angular velocity is needed). Independent check:
/// Simbody on the complete model, including locked coordinates (validation/second_ways).
///
/// More than maxFixedCoordinates, or maxFixedSegments, are simulated by tree() instead of motions()
/// and inertia(), which check it for a few coordinates (validation/second_ways).
///
/// Constant after construction; all evaluation functions are pure and do not allocate.
class Skeleton {
 public:
  /// @throws std::invalid_argument unknown or repeated coordinate names, a free coordinate that is
  ///   the dependent one of a coupler, no free coordinate, a joint tree that is not a tree
  Skeleton(const Model& model, const SkeletonOptions& options);

  int numCoordinates() const { return static_cast<int>(coordinates_.size()); }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Default values of the free coordinates [rad] or [m].
  Eigen::VectorXd defaultValues() const;
  std::size_t numSegments() const { return segments_.size(); }
  const std::vector<Segment>& segments() const { return segments_; }
  const Eigen::Vector3d& gravity() const { return gravity_; }

  /// @throws std::invalid_argument unknown body; "ground" is segment 0 at the identity
  const BodyPlacement& placeOf(const std::string& body) const;

  /// Index of a free coordinate, or −1 if it is locked or coupled.
  int indexOf(const std::string& coordinate) const;

  /// Value of any coordinate as a function of the free ones: q_k itself, a coupled function of it,
  /// or a constant.
  struct CoordinateSource {
    int freeIndex = -1;  ///< −1: constant
    double value = 0;    ///< used if constant
    FunctionEvaluator coupling{identityFunction()};
  };
  /// @throws std::invalid_argument unknown coordinate
  const CoordinateSource& sourceOf(const std::string& coordinate) const;

  /// Placement of every segment in ground with first and second derivatives; out has numSegments()
  /// entries, out[0] is the ground itself. T is double or an AD scalar.
  template <class T, int N>
  void motions(const Eigen::Matrix<T, N, 1>& q, RigidMotion<T, N>* out) const;

  /// Mass matrix, gravity and their derivatives; `moved` is what motions(q, ·) returned.
  template <int N>
  InertiaJet<N> inertia(const Eigen::Matrix<double, N, 1>& q,
                        const RigidMotion<double, N>* moved) const;

  /// The skeleton by spatial algebra; null: motions() and inertia() serve.
  const ArticulatedTree* tree() const { return tree_.get(); }

  /// Placement of every segment in ground at q, numCoordinates() values, for any number of them;
  /// out has numSegments() entries.
  void placements(const double* q, Placement<double>* out) const;

  /// True if M does not depend on q (a single hinge or slider): derivatives of M are exactly zero.
  bool hasConstantInertia() const { return constantInertia_; }

 private:
  /// A turn about, or a shift along, a fixed axis by f(q_k), after a fixed placement.
  struct Factor {
    Placement<double> before;
    bool turns = true;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit
    int freeIndex = 0;
    FunctionEvaluator coupling{identityFunction()};  ///< coordinate of the axis from q_k
    FunctionEvaluator amount{identityFunction()};  ///< angle [rad] or shift [m] from the coordinate
    bool isIdentity = true;                        ///< both functions are the identity
  };
  struct SegmentMotion {
    std::size_t parent = 0;
    std::vector<Factor> factors;
  };

  /// The amount and its derivatives in q_k.
  template <class T>
  static detail::CurveJet<T> amountOf(const Factor& factor, const T& q_k);
  /// X ← X·factor
  template <class T, int N>
  static void applyFactor(RigidMotion<T, N>& X, const Factor& factor, const T& q_k);
  /// X ← factor, for X = 1, the ground, whose derivatives are zero.
  template <class T, int N>
  static void applyFirstFactor(RigidMotion<T, N>& X, const Factor& factor, const T& q_k);

  std::vector<Coordinate> coordinates_;
  std::map<std::string, CoordinateSource> sources_;
  std::vector<Segment> segments_;
  std::vector<SegmentMotion> segmentMotions_;  ///< entry 0 unused
  std::map<std::string, BodyPlacement> places_;
  Eigen::Vector3d gravity_;
  bool constantInertia_ = false;
  double constantMass_ = 0;
  std::shared_ptr<const ArticulatedTree> tree_;
};

// Compiled once; other sizes and scalars need bio/skeleton/skeleton_motion.h.
extern template void Skeleton::motions<double, 1>(const Eigen::Matrix<double, 1, 1>&,
                                                  RigidMotion<double, 1>*) const;
extern template InertiaJet<1> Skeleton::inertia<1>(const Eigen::Matrix<double, 1, 1>&,
                                                   const RigidMotion<double, 1>*) const;

}  // namespace bio
