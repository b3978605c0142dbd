#pragma once

#include <vector>

#include "info/design/projected_motion.h"

namespace info {

/// What an information-optimal motion is to be. `modelState` is on (x, vec ψ), `gainState` on x.
///     J = ∫ ½|x − x̂|²_Q + ½|u − û|²_R dt + φ(I),   I = ∫ Γᵀ Σ⁻¹ Γ dt
/// Σ is here the noise's spectral density: a measurement at period τ with covariance C is Σ = C·τ,
/// and Σ = C makes I that of one sample a second, on which the weights of φ are relative.
struct FlowDesign : MotionDesign {
  double step = 0;                ///< between nodes [s] > 0
  Eigen::MatrixXd outputDensity;  ///< Σ [(output unit)² s]
  RiccatiIntegration riccati = RiccatiIntegration::rungeKutta;
};

/// Optimises a motion by the projection operator in continuous time (chapter 4): any smooth system,
/// with the input in the output or not (B.1, with the term of u that it lacks), or a stack of one
/// at several θ.
///
/// The equations are those of continuous time, then put on a grid: x and ψ by Runge–Kutta of order
/// 4, Riccati likewise, integrals by the trapezoidal rule, everything linear between nodes. DJ·ζ is
/// therefore the derivative of J(P(ξ + γζ)) up to O(step²); discrete_projection.h has it exactly.
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
  /// The closed loop u = β − K(x − α) from x0; without gains, u = β. False if it leaves the
  /// numbers.
  bool run(const std::vector<Eigen::VectorXd>& alpha, const std::vector<Eigen::VectorXd>& beta,
           const std::vector<Eigen::MatrixXd>& gains, Motion& motion) const;

  ExtendedFlow system_;
  FlowDesign design_;
  std::vector<Eigen::VectorXd> desiredState_;
};

}  // namespace info
