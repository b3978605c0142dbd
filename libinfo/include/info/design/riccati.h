#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info {

/// A linear time-varying system: z_{k+1} = A_k z_k + B_k v_k in discrete time, or ż = A z + B v
/// given at the nodes of a grid and linear in between.
struct LinearSequence {
  std::vector<Eigen::MatrixXd> A;  ///< n × n
  std::vector<Eigen::MatrixXd> B;  ///< n × m
};

/// An additional weight ½ zᵀQz at one node.
struct NodeWeight {
  std::size_t node;   ///< 0 … number of steps
  Eigen::MatrixXd Q;  ///< n × n, symmetric ⪰ 0
};

/// Weights of ½ zᵀQz + vᵀSz + ½ vᵀRv, constant except for those of `extra`.
struct QuadraticWeights {
  Eigen::MatrixXd Q;  ///< n × n, symmetric ⪰ 0
  Eigen::MatrixXd R;  ///< m × m, symmetric ≻ 0
  Eigen::MatrixXd S;  ///< m × n; empty: 0. Only in discrete time
  Eigen::MatrixXd
      Qf;  ///< n × n at the end, symmetric ⪰ 0; empty: Q in discrete time, 0 in continuous time
  std::vector<NodeWeight> extra = {};  ///< only in steps
};

/// The affine part aᵀz + bᵀv of a cost.
struct LinearCost {
  std::vector<Eigen::VectorXd> a;  ///< on z at every node: number of steps + 1
  std::vector<Eigen::VectorXd> b;  ///< on v: one per step, or at every node in continuous time
};

/// The minimiser of an affine LQ problem from z = 0.
struct AffineLqSolution {
  std::vector<Eigen::VectorXd> z;
  std::vector<Eigen::VectorXd> v;
  double slope;  ///< Σ aᵀz + bᵀv, or its integral: the first-order change of the cost; ≤ 0
};

/// Gains K_k of the time-varying LQR v_k = −K_k z_k in discrete time, by the backward sweep
///     H = R + BᵀPB,   K = H⁻¹(BᵀPA + S),   P ← Q + AᵀPA − KᵀHK,   P_K = Qf
/// @throws std::domain_error if a weight is not finite, not symmetric or not definite as required
///   above (named, with the eigenvalue), or if P overflows; std::invalid_argument if shapes do not
///   fit
std::vector<Eigen::MatrixXd> lqrGains(const LinearSequence& system,
                                      const QuadraticWeights& weights);

/// min Σ_{k<K} (aᵀz + bᵀv + ½zᵀQz + vᵀSz + ½vᵀRv) + a_Kᵀz_K + ½z_KᵀQf z_K, z_0 = 0, in discrete
/// time:
///     r ← a + Aᵀr − Kᵀ(Bᵀr + b),   v = −Kz − H⁻¹(Bᵀr + b)
/// @throws as lqrGains
AffineLqSolution affineLq(const LinearSequence& system, const LinearCost& cost,
                          const QuadraticWeights& weights);

/// Integration of Riccati equations in continuous time.
enum class RiccatiIntegration {
  rungeKutta,  ///< order 4, one step per interval
  adaptive     ///< CVODES with a relative tolerance of 1e-8
};

/// Gains K(t) at the nodes of a grid, continuous time:
///     −Ṗ = AᵀP + PA − PBR⁻¹BᵀP + Q,   P(T) = Qf,   K = R⁻¹BᵀP
/// integrated backwards, A and B linear between nodes.
/// @param step between nodes [s] > 0; @throws as above
std::vector<Eigen::MatrixXd> continuousLqrGains(
    const LinearSequence& system, double step, const QuadraticWeights& weights,
    RiccatiIntegration integration = RiccatiIntegration::rungeKutta);

/// min ∫ aᵀz + bᵀv + ½zᵀQz + ½vᵀRv dt + ½z(T)ᵀQf z(T), z(0) = 0, in continuous time:
///     −ṙ = (A − BK)ᵀr + a − Kᵀb,   v = −Kz − R⁻¹(Bᵀr + b)
/// z by the classical Runge–Kutta method; the slope is the trapezoidal sum over the nodes. Error
/// O(step²) for smooth A, B, a, b.
/// @throws as above
AffineLqSolution continuousAffineLq(
    const LinearSequence& system, double step, const LinearCost& cost,
    const QuadraticWeights& weights,
    RiccatiIntegration integration = RiccatiIntegration::rungeKutta);

}  // namespace info
