#pragma once

#include <vector>

#include "info/design/projected_motion.h"

namespace info {

/// The design of an information-optimal motion in continuous time. `modelState` is on (x, vec ψ),
/// `gainState` on x.
///     J = ∫ ½|x − x̂|²_Q + ½|u − û|²_R dt + φ(I),   I = ∫ Γᵀ Σ⁻¹ Γ dt
/// Here Σ is the spectral density of the noise: a measurement at period τ with covariance C has Σ =
/// C·τ. With Σ = C, I is that of one sample per second, to which the weights of φ refer.
struct FlowDesign : MotionDesign {
  double step = 0;                ///< between nodes [s] > 0
  Eigen::MatrixXd outputDensity;  ///< Σ [(output unit)² s]
  RiccatiIntegration riccati = RiccatiIntegration::rungeKutta;
};

/// Optimises a motion by the projection operator in continuous time (chapter 4 of Wilson's thesis),
/// for any smooth system or a stack of one at several θ. The output may depend on the input (B.1,
/// with the term of u that is missing there).
///
/// The continuous-time equations are discretised on a grid: x, ψ and the Riccati equation by
/// Runge–Kutta of order 4, integrals by the trapezoidal rule, everything linear between nodes. DJ·ζ
/// is therefore the derivative of J(P(ξ + γζ)) up to O(step²); in discrete_projection.h it is
/// exact.
class FlowProjection : public ProjectedMotion {
 public:
  /// Starts from the motion of `start` (inputs at the nodes), or of the desired inputs.
  /// @throws as StepProjection
  FlowProjection(ExtendedFlow system, FlowDesign design,
                 const std::vector<Eigen::VectorXd>& start = {});

  Direction findDirection(double repeatedTolerance) override;

 private:
  double tracking(const Motion& motion) const override;
  double share(std::size_t k) const override;
  bool project(double step, Motion& motion) const override;
  std::size_t steps() const { return design_.desiredInput.size() - 1; }
  /// The closed loop u = β − K(x − α) from x0; without gains, u = β. False if it does not stay
  /// finite.
  bool run(const std::vector<Eigen::VectorXd>& alpha, const std::vector<Eigen::VectorXd>& beta,
           const std::vector<Eigen::MatrixXd>& gains, Motion& motion) const;

  ExtendedFlow system_;
  FlowDesign design_;
  std::vector<Eigen::VectorXd> desiredState_;
};

}  // namespace info
