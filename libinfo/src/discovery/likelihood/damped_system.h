#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info::discover {

/// Something over (ξ, η), each trial's η apart.
struct JointVector {
  Eigen::VectorXd xi;
  std::vector<Eigen::VectorXd> eta;
  double norm() const;
};

/// The normal equations of a fit over (ξ, η), each trial's η in a block of its own:
///     [ A  B₁ᵀ … ] [dξ ]   [ a  ]
///     [ B₁ C₁    ] [dη₁] = [ b₁ ]
///     [ ⋮      ⋱ ] [ ⋮ ]   [ ⋮  ]
/// damped and factored once for several right-hand sides, η eliminated first.
class DampedSystem {
 public:
  struct Blocks {
    Eigen::MatrixXd information;            ///< A
    std::vector<Eigen::MatrixXd> coupling;  ///< B, no rows where a trial has no latent force
    std::vector<Eigen::MatrixXd> latent;    ///< C
  };

  /// A's diagonal times 1 + λ, λ added to C's (whose prior is 1).
  DampedSystem(const Blocks& blocks, double damping);

  /// What pulls at ξ once η has followed: a − ΣBᵀC⁻¹b.
  Eigen::VectorXd pull(const JointVector& right) const;
  /// dξ of a pull; only `moving` ones move.
  Eigen::VectorXd solve(const Eigen::VectorXd& pull, const std::vector<Eigen::Index>& moving) const;
  /// How η follows dξ.
  std::vector<Eigen::VectorXd> follow(const JointVector& right, const Eigen::VectorXd& xi) const;

 private:
  const Blocks& blocks_;
  Eigen::MatrixXd reduced_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
};

}  // namespace info::discover
