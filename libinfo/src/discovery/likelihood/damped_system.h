#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info::discover {

/// A vector over (ξ, η), with one block of η per trial.
struct JointVector {
  Eigen::VectorXd xi;
  std::vector<Eigen::VectorXd> eta;
  double norm() const;
};

/// The normal equations of a fit over (ξ, η), with one block of η per trial:
///     [ A  B₁ᵀ … ] [dξ ]   [ a  ]
///     [ B₁ C₁    ] [dη₁] = [ b₁ ]
///     [ ⋮      ⋱ ] [ ⋮ ]   [ ⋮  ]
/// damped and factored once for several right-hand sides, η eliminated first.
class DampedSystem {
 public:
  struct Blocks {
    Eigen::MatrixXd information;            ///< A
    std::vector<Eigen::MatrixXd> coupling;  ///< B, without rows for a trial without latent force
    std::vector<Eigen::MatrixXd> latent;    ///< C
  };

  /// A's diagonal times 1 + λ, λ added to C's (whose prior is 1).
  DampedSystem(const Blocks& blocks, double damping);

  /// The right-hand side for ξ after elimination of η: a − ΣBᵀC⁻¹b.
  Eigen::VectorXd pull(const JointVector& right) const;
  /// dξ for a right-hand side; only the components in `moving` change.
  Eigen::VectorXd solve(const Eigen::VectorXd& pull, const std::vector<Eigen::Index>& moving) const;
  /// dη for a given dξ.
  std::vector<Eigen::VectorXd> follow(const JointVector& right, const Eigen::VectorXd& xi) const;

 private:
  const Blocks& blocks_;
  Eigen::MatrixXd reduced_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
};

}  // namespace info::discover
