#pragma once

// Rates of a tree's mass matrix along a motion; not public.

#include "bio/skeleton/tree_energy.h"
#include "info/autodiff/dual.h"

namespace bio::stepping {

/// Terms of inertia that Newton's method needs beyond tree_energy.h: the derivative of the
/// energies' second derivatives along q̇, by one pass with a dual number at q + ε q̇.
class TreeRates {
 public:
  /// The tree must outlive this object.
  explicit TreeRates(const ArticulatedTree& tree);

  /// At q with speed v.
  void evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Eigen::MatrixXd& massRate() const { return massRate_; }  ///< Ṁ = Σ v_j ∂_jM
  /// Σ_j v_j ∂_j∂_k(M v): column k is ∂(Ṁ v)/∂q_k.
  const Eigen::MatrixXd& momentumRate() const { return momentumRate_; }

 private:
  using Dual = info::Dual<1>;
  const ArticulatedTree* tree_;
  TreeMotion<Dual> motion_;
  TreeEnergy<Eigen::Dynamic, Dual> energy_;
  std::vector<Dual> q_, v_;
  Eigen::MatrixXd massRate_, momentumRate_;
};

}  // namespace bio::stepping
