#pragma once

#include <vector>

#include "info/design/projected_motion.h"

namespace info {

/// A target state at one time: adds ½|x_k − state|²_W to J.
struct StepWaypoint {
  std::size_t step;        ///< k, 1 … K
  Eigen::VectorXd state;   ///< used where W > 0
  Eigen::MatrixXd weight;  ///< W: n × n ⪰ 0
};

/// The design of an information-optimal motion in discrete time. `modelState` is on (x, u_k, vec
/// ψ), `gainState` on (x, u_k).
///     J = Σ_{k=1..K} ½|x_k − x̂_k|²_Q + ½|u_k − û_k|²_R + ½|(u_k − u_{k−1})/Δt − same of û|²_V +
///     φ(I) I = Σ_{k ∈ measured} Γ_kᵀ Σ⁻¹ Γ_k,   Γ_k = D_x g ψ_k + D_θ g
/// The decision is u_1 … u_K; x_0, u_0 and ψ_0 = 0 are given.
struct StepDesign : MotionDesign {
  double timeStep = 0;                       ///< Δt [s] > 0
  Eigen::MatrixXd outputCovariance;          ///< Σ of one sample
  std::size_t stepsPerSample = 1;  ///< measured at k = s, 2s, …; otherwise Σ_k⁻¹ = 0
  Eigen::MatrixXd rateWeight;                ///< V: m × m ⪰ 0, on the rate of u; empty: 0
  Eigen::MatrixXd modelRate;                 ///< the same for the direction: m × m ⪰ 0; empty: 0
  std::vector<StepWaypoint> waypoints = {};  ///< also weights of the quadratic model
};

/// Optimises a motion by the projection operator in discrete time (chapter 5 of Wilson's thesis),
/// for any step map and any parameters, or for a stack of one map at several θ. The derivatives of
/// the extended system (5.1) are exact, so that DJ·ζ is the derivative of J(P(ξ + γζ)) to rounding.
///
/// u_k is a state beside x_k, because a step may depend on the input at both of its ends; the
/// projection feeds back (x, u_k), and ψ follows from it.
class StepProjection : public ProjectedMotion {
 public:
  /// Starts from the motion of `start` (inputs u_0 … u_K), or of the desired inputs.
  /// @throws std::invalid_argument, std::domain_error naming a broken rule: sizes, weights, limits
  ///   (lower < upper, weight > 0, u_0 within), a start at which a step of the map fails (with the
  ///   time)
  /// @throws NoInformation if the start has no information about some combination of parameters
  StepProjection(ExtendedStepMap system, StepDesign design,
                 const std::vector<Eigen::VectorXd>& start = {});

  Direction findDirection(double repeatedTolerance) override;

 private:
  double tracking(const Motion& motion) const override;
  double share(std::size_t k) const override;
  bool project(double step, Motion& motion) const override;
  std::size_t steps() const { return design_.desiredInput.size() - 1; }

  ExtendedStepMap system_;
  StepDesign design_;
  std::vector<Eigen::VectorXd> desiredState_;
};

}  // namespace info
