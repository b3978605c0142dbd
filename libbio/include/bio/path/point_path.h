#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/path/span.h"
#include "bio/skeleton/segment_chain.h"

namespace bio {

/// A length and its derivatives over a support: those coordinates that can change it. Holds the
/// work space of its evaluation.
template <class T>
struct SupportedLength {
  T length{0.0};                                            ///< L [m]
  Eigen::Matrix<T, Eigen::Dynamic, 1> first;                ///< ∂L/∂q over the support
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> second;  ///< ∂²L/∂q²
  std::vector<Vec3<T>> moves;                               ///< work: of a chain's steps, twice
  std::vector<Vec3<T>> slotMoves;                           ///< work: of each coordinate, twice
};

/// A fixed point of a segment.
struct Station {
  int segment = 0;
  Eigen::Vector3d p_S = Eigen::Vector3d::Zero();  ///< in the segment's frame [m]
};

/// Where a station is in the ground [m].
template <class T>
Vec3<T> stationInGround(const TreeMotion<T>& motion, const Station& station) {
  const Placement<T>& X = motion.segments[static_cast<std::size_t>(station.segment)];
  Vec3<T> x;
  for (int i = 0; i < 3; ++i) {
    x[i] = X.R(i, 0) * station.p_S[0] + X.R(i, 1) * station.p_S[1] + X.R(i, 2) * station.p_S[2] +
           X.p[i];
  }
  return x;
}

/// The length of straight pieces from station to station over moving segments.
///
/// L = Σ |x_b − x_a|. A piece is seen from the segment at which it begins, so that only the other
/// end moves, by the mobilities between the two segments (segment_chain.h). With t = (x_b − x_a)/L
/// and u_i the movement of x_b by coordinate i of the support,
///     ∂_iL = t·u_i,   ∂_ijL = (u_i·u_j − ∂_iL ∂_jL)/L + t·∂_ijx
/// Pieces within one segment are a constant. A point that moves in its body by functions of
/// coordinates is a segment of its own (ArticulatedTree::addMovingPoint).
///
/// C∞ while no piece has length 0, where derivatives are not finite.
class PointPath {
 public:
  /// @throws std::invalid_argument fewer than two stations, a point that is not finite, a segment
  ///   that the tree does not have
  PointPath(const ArticulatedTree& tree, const std::vector<Station>& stations);

  /// Indices of the coordinates that can change the length, rising.
  const std::vector<int>& support() const { return support_; }

  template <class T>
  SupportedLength<T> newLength() const;

  /// Overwrites `out`, made by newLength(); does not allocate.
  template <class T>
  void evaluate(const TreeMotion<T>& motion, SupportedLength<T>& out) const;

 private:
  struct Piece {
    Station from, to;
    SegmentChain chain;
    std::vector<int> slots;  ///< of the support that this piece has
  };
  double constantLength_ = 0;
  std::vector<Piece> pieces_;
  std::vector<int> support_;
};

/// Adds a piece P–Q that bends over a surface of a segment C, of which length, gradient and Hessian
/// in C's frame are known (any wrap rule), to a length over a larger support: only the mobilities
/// between C and each end count.
///     ∂_iL = g_P·u_i + g_Q·w_i,
///     ∂_ijL = u_iᵀH_PP u_j + u_iᵀH_PQ w_j + w_iᵀH_PQᵀu_j + w_iᵀH_QQ w_j + g_P·∂_ijx_P +
///     g_Q·∂_ijx_Q
/// with u, w the movements of P and Q seen from C. `X_GC` is C's placement in the ground; chains
/// go from C's segment to those of P and Q and are numbered by the support of `out`.
template <class T>
void addSpan(const SpanToSecondOrder<T>& span, const Placement<T>& X_GC, const SegmentChain& toP,
             const Vec3<T>& p_GP, const SegmentChain& toQ, const Vec3<T>& p_GQ,
             const TreeMotion<T>& motion, SupportedLength<T>& out);

}  // namespace bio

#include "bio/path/point_path_bodies.h"
