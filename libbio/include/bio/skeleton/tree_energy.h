#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "bio/skeleton/articulated_tree.h"

namespace bio {

/// Kinetic energy T(q, v) = ½vᵀM(q)v and potential energy V(q) of a tree with all their first and
/// second derivatives; v are the rates of the coordinates. Never ∂M/∂q or ∂²M/∂q² by themselves.
template <int N, class T = double>
struct EnergyDerivatives {
  using Vector = Eigen::Matrix<T, N, 1>;
  using Matrix = Eigen::Matrix<T, N, N>;
  T kinetic{0.0};    ///< T [J]
  T potential{0.0};  ///< V = −Σ m g·r [J], 0 with all mass centres at the ground's origin
  Vector T_v;        ///< ∂T/∂v = M v
  Vector T_q;        ///< ∂T/∂q = ½vᵀ(∂M/∂q)v
  Matrix T_vv;       ///< ∂²T/∂v² = M
  Matrix T_vq;       ///< rows v, columns q: ∂(M v)/∂q, linear in v
  Matrix T_qq;       ///< ½vᵀ(∂²M/∂q²)v
  Vector V_q;        ///< ∂V/∂q; the generalised force of gravity is −V_q
  Matrix V_qq;       ///< ∂²V/∂q²
};

/// The energies of an articulated tree and the derivatives that a variational step needs.
///
/// With V_j the velocity just before mobility j, H_j and I_j momentum and inertia of everything
/// beyond it (S, D: articulated_tree.h), G_j = S_j ×* H_j, b_j = S_j × V_j − D_j v_j,
/// d_j = ω_j × Σmr + s_j Σm, and k on the way from the ground to j, or j itself:
///     T_v,j = S_j·H_j                T_q,j = −b_j·H_j              V_q,j = −g·d_j
///     M_jk = S_k·I_j S_j             T_qq,jk = b_k·(I_j b_j − G_j)  V_qq,jk = −g·(ω_k × d_j)
///     T_v_j q_k = −b_k·I_j S_j       T_v_k q_j = S_k·(G_j − I_j b_j)  for k ≠ j
/// and for j with itself besides
///     T_v_j q_j += D_j·H_j,  T_qq,jj += (∂_jD_j v_j − D_j × V_j)·H_j,  V_qq,jj −= g·(D_j at d)
/// All others are 0: the cost is that of pairs of which one is on the way to the other. Mobilities
/// of one coordinate are summed. Derived from ∂_jV = S_j × V − b_j beyond j; checked against
/// duals, central differences, skeleton.h and Simbody.
///
/// Constant inertia (one hinge or slider) takes a short cut: only V is computed.
///
/// Holds the work space of an evaluation, so it belongs to one thread; evaluate() does not
/// allocate. N is 1 or Eigen::Dynamic.
template <int N, class T = double>
class TreeEnergy {
 public:
  /// The tree must outlive this object.
  /// @throws std::invalid_argument N fixed and not the tree's number of coordinates
  explicit TreeEnergy(const ArticulatedTree& tree);

  /// At the posture of which `motion` was made, with rates v, numCoordinates() values. The result
  /// is overwritten by the next call.
  const EnergyDerivatives<N, T>& evaluate(const TreeMotion<T>& motion, const T* v);

 private:
  /// Data of a mobility for pairs in which it is the one nearer to the ground.
  struct Inner {
    SpatialVector<T> S, b;
  };
  void setZero();
  void constantInertia(const TreeMotion<T>& motion, const T* v);
  void outward(const TreeMotion<T>& motion, const T* v);
  void inward();
  void pairs(const TreeMotion<T>& motion, const T* v);
  void bentScrew(const TreeMotion<T>& motion, std::size_t j, const T& v, int c);

  const ArticulatedTree* tree_;
  std::vector<Inner> inner_;
  std::vector<SpatialVector<T>> before_;    ///< V_j
  std::vector<SpatialVector<T>> velocity_;  ///< of each segment
  std::vector<SpatialVector<T>> momentum_;  ///< of each segment, then H of it and all beyond
  std::vector<SpatialInertia<T>> inertia_;  ///< likewise
  EnergyDerivatives<N, T> out_;
};

// Compiled once; other scalars need bio/skeleton/tree_energy_bodies.h.
extern template class TreeEnergy<1, double>;
extern template class TreeEnergy<Eigen::Dynamic, double>;

}  // namespace bio
