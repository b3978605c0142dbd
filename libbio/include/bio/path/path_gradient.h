#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/path/path.h"
#include "bio/path/tree_path.h"
#include "bio/skeleton/skeleton.h"

namespace bio {

/// Rows of a PathGradient for each wrap object; of a vector the first of three.
namespace wrap_rows {
inline constexpr int radius = 0;       ///< of a cylinder or sphere
inline constexpr int translation = 1;  ///< in the body
inline constexpr int rotation = 4;     ///< in the body
inline constexpr int numbers = 7;  ///< semi-axes of an ellipsoid; outer, inner radius of a torus
inline constexpr int count = 10;
}  // namespace wrap_rows

/// Derivatives of a muscle–tendon length and its slope with respect to the parameters of the path:
/// column 0 is ∂ℓ/∂θ, column 1 + k is ∂²ℓ/∂q_k∂θ, one row per θ. N = Eigen::Dynamic: k counts the
/// coordinates of the path's support.
template <int N>
struct PathGradient {
  static constexpr int columns = N == Eigen::Dynamic ? Eigen::Dynamic : 1 + N;
  using OfPoint = Eigen::Matrix<double, 3, columns>;
  /// by wrap_rows
  using OfWrap = Eigen::Matrix<double, wrap_rows::count, columns>;
  std::vector<OfPoint> points;  ///< of Path::points, over their locations in their bodies [1]
  std::vector<OfWrap> wraps;    ///< of Path::wraps; unused for a wrap that is left out
};

/// Gradients of a MusclePath in the locations of its points and in the radii, positions and
/// orientations of its wrap objects.
///
/// The length is stationary in the contact points, so its gradient in a span's ends are the end
/// tangents c, and the change of those as q_k moves the ends is g_k = H·∂_k(ends). A point's
/// location pulls them back through its placement; a shift of the surface is the opposite shift of
/// both ends, a turn ω of it moves them by −ω×p, which leaves the moment Σ p×c. The radius is
/// carried through the span by the scalar type. Chains (path_chain.h) give way by ChainChanges, and
/// their surfaces' numbers by contactNumbers. Spans that do not move contribute a constant.
///
/// A moving point's location is that of its functions plus a constant shift. The side of a path and
/// the objects that a span may touch are held fixed.
class PathGradients {
 public:
  /// @throws std::invalid_argument names that the model lacks
  PathGradients(const Model& model, const Skeleton& skeleton, const Muscle& muscle,
                const MusclePath& path);

  /// Zero gradients of the right sizes: a workspace for evaluate.
  template <int N>
  PathGradient<N> workspace() const;

  /// Into `out`; `moved` is what Skeleton::motions(q, ·) returned. Allocates nothing.
  template <int N>
  void evaluate(const Eigen::Matrix<double, N, 1>& q, const RigidMotion<double, N>* moved,
                PathGradient<N>& out) const;

  /// Workspace and gradients of a path over a tree.
  PathGradient<Eigen::Dynamic> workspace(const TreePath& path) const;
  /// @param work  of the path, TreePath::newWork()
  void evaluate(const Eigen::VectorXd& q, const TreePath& path, const ArticulatedTree& tree,
                const TreeMotion<double>& motion, SupportedLength<double>& work,
                PathGradient<Eigen::Dynamic>& out) const;

  /// Whether a span may touch, in some posture, the wrap object with this index in Path::wraps.
  bool mayTouch(std::size_t wrap) const { return mayTouch_[wrap]; }
  /// Whether the point with this index in Path::points is active in some posture.
  bool isUsed(std::size_t point) const { return used_[point]; }

 private:
  /// Derivatives with respect to a wrap object's frame in its body: the rotation from body to
  /// segment, and the axes of rotation in the surface's frame.
  struct SurfaceFrame {
    Eigen::Matrix3d R_SB;
    Eigen::Matrix3d turnAxes;  ///< columns: for the three angles of the frame
  };
  template <int N>
  void addSpan(const PathSpan& span, const Eigen::Matrix<double, N, 1>& q,
               const RigidMotion<double, N>* moved, unsigned& usedSurfaces, bool isFixed,
               PathGradient<N>& out) const;
  template <int N>
  void addChain(const PathSpan& span, const Eigen::Matrix<double, N, 1>& q,
                const RigidMotion<double, N>* moved, unsigned& usedSurfaces,
                PathGradient<N>& out) const;

  struct TreeSpan;
  void addSurface(const TreeSpan& span, const detail::SpanOverSurface& s,
                  PathGradient<Eigen::Dynamic>& out) const;
  void addTreePoint(const TreeSpan& span, std::size_t node, const SegmentChain* chain,
                    const Eigen::Vector3d& c, std::size_t slopes,
                    PathGradient<Eigen::Dynamic>& out) const;
  bool addTreeChain(const TreeSpan& span, const Eigen::Vector3d& P, const Eigen::Vector3d& Q,
                    unsigned& used, PathGradient<Eigen::Dynamic>& out) const;

  const CompiledPath* path_;
  std::vector<std::string> bodies_;  ///< of the path's points
  std::size_t numPoints_, numWraps_;
  std::vector<SurfaceFrame> frames_;       ///< of CompiledPath::surfaces
  std::vector<PathGradient<0>> constant_;  ///< of the fixed spans, per variant
  std::vector<bool> mayTouch_, used_;
};

}  // namespace bio
