#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "bio/path/path.h"
#include "bio/path/point_path.h"

namespace bio {

/// A muscle–tendon length over any number of coordinates, of which its support can change it.
template <>
struct LengthJet<Eigen::Dynamic, double> {
  double length = 0;         ///< ℓ_MT [m]
  Eigen::VectorXd dL_dq;     ///< over all coordinates [m/rad]; 0 outside the support
  std::vector<int> support;  ///< indices of coordinates, rising
  Eigen::MatrixXd second;    ///< ∂²ℓ/∂q² over the support [m/rad²]
  bool wrapped = false;      ///< a moving span touches a wrap object

  /// ∂²ℓ/∂q_i∂q_j of two coordinates.
  double secondIn(int i, int j) const;
};

/// Segments of a skeleton as places in its tree.
class TreePlaces {
 public:
  /// The skeleton must have a tree.
  explicit TreePlaces(const Skeleton& skeleton);

  int segmentOf(std::size_t segment) const { return places_[segment].segment; }
  /// Placement of the skeleton's segment in the tree's.
  const Placement<double>& offsetOf(std::size_t segment) const { return places_[segment].X_TS; }
  /// A point of a skeleton's segment.
  Station station(std::size_t segment, const Vec3<double>& p_S) const;

 private:
  struct Place {
    int segment = 0;
    Placement<double> X_TS;
  };
  std::vector<Place> places_;
};

/// A compiled path over an articulated tree: any number of coordinates, each span with those
/// between its ends only.
///
/// A straight span is seen from the segment at which it begins (point_path.h), one over a wrap
/// object from that object's segment: length, gradient and Hessian in its ends by the wrap rule,
/// then addSpan. Objects that are passed together (path_chain.h) move ends and objects as screws.
/// Which spans, sides and objects count is as for MusclePath::length.
class TreePath {
 public:
  /// A surface that a span may go over, seen from a segment.
  struct OverSurface {
    SpanSurface way;
    int segment = 0;         ///< of the tree
    Placement<double> X_SC;  ///< surface in it
    SegmentChain toP, toQ;
  };
  /// Surfaces that are passed together, seen from the segment of the first of them.
  struct OverChain {
    struct Member {
      int segment = 0;         ///< of the tree
      Placement<double> X_TC;  ///< surface in it
      SegmentChain chain;      ///< from the carrier to it
    };
    std::size_t chain = 0;   ///< in CompiledPath::chains
    int carrier = 0;         ///< segment of the tree
    Placement<double> X_TS;  ///< the skeleton's segment in it
    std::vector<Member> members;
    SegmentChain toP, toQ;
  };
  struct Piece {
    std::size_t a = 0, b = 0;  ///< nodes of the compiled path
    Station from, to;
    SegmentChain chain;
    std::vector<int> slots;  ///< of the support that the straight span has
    std::vector<OverSurface> surfaces;
    std::optional<OverChain> overChain;  ///< then without `surfaces`
  };

  /// @param tree  of the skeleton; points that move in their bodies become segments of it
  /// @param path  MusclePath::compiled() of the muscle
  TreePath(ArticulatedTree& tree, const Skeleton& skeleton, const Muscle& muscle,
           const CompiledPath& path);

  /// Indices of the coordinates that can change the length, rising.
  const std::vector<int>& support() const { return support_; }

  /// Work space and result of the right sizes.
  SupportedLength<double> newWork() const;
  LengthJet<Eigen::Dynamic> newLength(int numCoordinates) const;

  /// Overwrites `out`; allocates nothing.
  /// @param q  the configuration, and `motion` the tree placed there
  /// @param conditionsAt  the configuration whose conditional points are active
  void evaluate(const CompiledPath& path, const Eigen::VectorXd& q,
                const Eigen::VectorXd& conditionsAt, const TreeMotion<double>& motion,
                SupportedLength<double>& work, LengthJet<Eigen::Dynamic>& out) const;

  /// The moving spans of a variant of the compiled path.
  const std::vector<Piece>& pieces(std::size_t variant) const { return variants_[variant]; }

 private:
  std::vector<std::vector<Piece>> variants_;
  std::vector<int> support_;
};

/// The paths of some muscles over a tree of their own, for lengths without a whole system.
class TreePaths {
 public:
  /// The skeleton must have a tree and outlive this object.
  explicit TreePaths(const Skeleton& skeleton) : skeleton_(&skeleton), tree_(*skeleton.tree()) {}

  /// The path must outlive this object.
  void add(const Muscle& muscle, const MusclePath& path);
  /// Places the skeleton; call after the last add().
  void moveTo(const Eigen::VectorXd& q);
  /// Evaluates one path there. @throws std::domain_error if it has no taut string
  const LengthJet<Eigen::Dynamic>& length(std::size_t index);

 private:
  const Skeleton* skeleton_;
  ArticulatedTree tree_;
  Eigen::VectorXd q_;
  std::optional<TreeMotion<double>> motion_;
  std::vector<const MusclePath*> compiled_;
  std::vector<TreePath> paths_;
  std::vector<SupportedLength<double>> work_;
  std::vector<LengthJet<Eigen::Dynamic>> lengths_;
};

namespace detail {

/// The surface that a span of a tree goes over, and the span in the surface's frame.
struct SpanOverSurface {
  const TreePath::OverSurface* over = nullptr;  ///< null: the span is straight
  Placement<double> X_GC;
  Vec3<double> p_CP, p_CQ;
  SpanToSecondOrder<double> span;
};

/// The first surface that the span touches and that is not in use; marks it used.
SpanOverSurface spanOverSurface(const CompiledPath& path, const TreePath::Piece& piece,
                                const TreeMotion<double>& motion, const Vec3<double>& p_GP,
                                const Vec3<double>& p_GQ, unsigned& used);

}  // namespace detail
}  // namespace bio
