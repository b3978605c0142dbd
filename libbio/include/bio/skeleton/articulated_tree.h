#pragma once

#include <Eigen/Dense>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/model.h"
#include "bio/muscle/curves/curves.h"
#include "bio/skeleton/skeleton.h"
#include "bio/skeleton/spatial_algebra.h"

namespace bio {

/// The value of a coordinate as a function of the free ones: q_k itself, a function of it, or a
/// constant.
struct CoordinateSource {
  int freeIndex = -1;  ///< −1: constant
  double value = 0;    ///< used if constant [rad] or [m]
  FunctionEvaluator coupling{identityFunction()};
};

/// One rigid segment of a tree and the way it hangs on another.
struct TreeSegment {
  std::string name;  ///< of its first body; "ground" for segment 0
  double mass = 0;   ///< [kg]
  Eigen::Vector3d massCenter = Eigen::Vector3d::Zero();  ///< in the segment's frame [m]
  /// xx yy zz xy xz yz about the mass centre, in the segment's frame [kg m²]
  Eigen::Matrix<double, 6, 1> inertia = Eigen::Matrix<double, 6, 1>::Zero();
  int parent = -1;        ///< segment, −1 for the ground
  int firstMobility = 0;  ///< its mobilities are firstMobility … lastMobility, inside out
  int lastMobility = -1;
};

/// A turn about the z-axis of a frame, or a shift along an axis of it, by amount(coupling(q)); the
/// frame is placed by `before` in the one that the turn or shift before it leaves.
struct ElementaryMotion {
  Placement<double> before;
  bool isPlacedStraight = true;  ///< before.R = 1
  bool turns = true;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit; z for a turn
  FunctionEvaluator coupling{identityFunction()};
  FunctionEvaluator amount{identityFunction()};      ///< [rad] or [m]
  bool isIdentity = true;                            ///< amount(coupling(q)) = q
  std::optional<FunctionEvaluator::Line> line = {};  ///< amount, if it is one of q itself
};

/// All turns and shifts in a row by one coordinate: a joint of one degree of freedom whose screw
/// may bend.
struct Mobility {
  int coordinate = 0;  ///< index of q
  int segment = 0;     ///< that it moves first
  int parent = -1;     ///< mobility before it on the way from the ground, −1: none
  int firstMotion = 0;
  int numMotions = 0;
  bool hasFixedScrew = false;  ///< one turn or shift by a line of q: ∂S/∂q = 0
};

/// A tree in a posture q; all vectors in the ground, about its origin. Made once with
/// ArticulatedTree::newMotion(), then filled as often as wanted without allocation.
///
/// With S_j the screw of mobility j per unit of its coordinate, everything beyond it obeys
/// ∂_j(any screw or placement) = S_j × (it); its own screw changes by D_j = ∂S_j/∂q_j.
template <class T>
struct TreeMotion {
  std::vector<Placement<T>> segments;    ///< of each segment, 0 is the ground itself
  std::vector<SpatialVector<T>> screw;   ///< S of each mobility
  std::vector<SpatialVector<T>> screw1;  ///< D = ∂S/∂q by its own coordinate
  std::vector<SpatialVector<T>> screw2;  ///< ∂²S/∂q²
};

/// The moving part of a model with any number of free coordinates, by spatial algebra.
///
/// Joints become turns and shifts by functions of single coordinates (couplers and joint functions
/// are such functions); all turns and shifts in a row by one coordinate form a mobility with world
/// screw S, and with S_f the screw of one of them and φ its amount
///     D ← D + φ″ S_f + φ′ S × S_f,   S ← S + φ′ S_f
/// (S, D: sums of those before it). No placement has a stored derivative: where mobility j is on
/// the way from the ground to a point x, ∂_jx = ω_j × x + s_j, and ∂_k∂_jx = ω_k × ∂_jx for k
/// before j.
///
/// Bodies that do not move against each other are lumped. Angles are those of OpenSim's custom
/// joints: shifts first, then turns. Screws are about the ground's origin, so relative rounding
/// errors grow with the square of (distance from it over size of the body).
/// Independent checks: skeleton.h up to four coordinates, Simbody for any number.
///
/// Constant after construction; evaluation is pure and does not allocate.
class ArticulatedTree {
 public:
  /// @throws std::invalid_argument unknown or repeated coordinate names, a free or locked
  /// coordinate
  ///   that is the dependent one of a coupler, a locked value that is not finite, no free
  ///   coordinate, one that moves nothing, a joint tree that is not a tree
  ArticulatedTree(const Model& model, const SkeletonOptions& options);

  int numCoordinates() const { return static_cast<int>(coordinates_.size()); }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  /// Default values of the free coordinates [rad] or [m].
  Eigen::VectorXd defaultValues() const;
  /// Index of a free coordinate, or −1 if it is locked or coupled.
  int indexOf(const std::string& coordinate) const;
  /// @throws std::invalid_argument unknown coordinate
  const CoordinateSource& sourceOf(const std::string& coordinate) const;

  const std::vector<TreeSegment>& segments() const { return segments_; }
  const std::vector<Mobility>& mobilities() const { return mobilities_; }
  const std::vector<ElementaryMotion>& motions() const { return motions_; }
  const Eigen::Vector3d& gravity() const { return gravity_; }  ///< [m/s²]
  /// Segments 0 … numMassSegments() − 1 carry the model's bodies; those after them moving points.
  int numMassSegments() const { return numMassSegments_; }
  /// True if M does not depend on q: a single hinge or slider.
  bool hasConstantInertia() const;

  /// @throws std::invalid_argument unknown body; "ground" is segment 0 at the identity
  const BodyPlacement& placeOf(const std::string& body) const;

  /// Adds a massless segment whose origin is a point that moves in a body by functions of
  /// coordinates, and returns it. Motions made before lack it.
  /// @throws std::invalid_argument unknown body or coordinate
  int addMovingPoint(const std::string& body, const PointMotion& motion);

  /// The last mobility on the way from the ground to a segment, −1 if nothing moves it.
  int mobilityOf(int segment) const { return segmentMobility_[static_cast<std::size_t>(segment)]; }

  template <class T>
  TreeMotion<T> newMotion() const;

  /// Placements and screws at q, numCoordinates() values. T is double or a dual number (derivatives
  /// of screw2, third ones of functions, are exact for cubics only).
  template <class T>
  void place(const T* q, TreeMotion<T>& out) const;

 private:
  friend class TreeBuilder;
  std::vector<Coordinate> coordinates_;
  std::map<std::string, CoordinateSource> sources_;
  std::vector<TreeSegment> segments_;
  std::vector<int> segmentMobility_;
  std::vector<Mobility> mobilities_;
  std::vector<ElementaryMotion> motions_;
  std::map<std::string, BodyPlacement> places_;
  Eigen::Vector3d gravity_;
  int numMassSegments_ = 1;
};

/// Every coordinate of a model that no coupler drives, in the order of its joints.
std::vector<std::string> independentCoordinates(const Model& model);

// Compiled once; other scalars need bio/skeleton/tree_motion.h.
extern template TreeMotion<double> ArticulatedTree::newMotion<double>() const;
extern template void ArticulatedTree::place<double>(const double*, TreeMotion<double>&) const;

}  // namespace bio
