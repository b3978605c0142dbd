#pragma once

#include <vector>

#include "info/extended_system.h"
#include "info/trajectory_search.h"

namespace info {

/// A motion in steps: x_0 … x_K, u_0 … u_K and ψ_0 … ψ_K.
struct StepMotion {
  std::vector<Eigen::VectorXd> x;
  std::vector<Eigen::VectorXd> u;
  std::vector<Eigen::MatrixXd> psi;
};

/// What an information-optimal motion in steps is to be. N = n + m + np.
///     J = Σ_{k=1..K} ½|x_k − x̂_k|²_Q + ½|u_k − û_k|²_R + ½|(u_k − u_{k−1})/Δt − same of û|²_V +
///     φ(I) I = Σ_{k ∈ measured} Γ_kᵀ Σ⁻¹ Γ_k,   Γ_k = D_x g ψ_k + D_θ g
/// The decision is u_1 … u_K; x_0, u_0 and ψ_0 = 0 are given.
struct StepDesign {
  double timeStep = 0;  ///< Δt [s] > 0
  Eigen::VectorXd x0;
  std::vector<Eigen::VectorXd> desiredInput;  ///< û_0 … û_K; x̂ is the motion these give
  Eigen::MatrixXd outputCovariance;           ///< Σ of one sample
  std::size_t stepsPerSample = 1;  ///< measured at k = s, 2s, …; between, Σ_k⁻¹ = 0

  InformationWeights information;
  Eigen::MatrixXd stateWeight;  ///< Q: n × n ⪰ 0; empty: 0
  Eigen::MatrixXd inputWeight;  ///< R: m × m ⪰ 0; empty: 0
  Eigen::MatrixXd rateWeight;   ///< V: m × m ⪰ 0, on the rate of u; empty: 0
  InputLimits limits;

  // the quadratic model that shapes the direction: ½|z|² of states, inputs, rate of inputs
  Eigen::MatrixXd modelState;  ///< on (x, u_k, vec ψ): N × N ⪰ 0
  Eigen::MatrixXd modelInput;  ///< on u_{k+1}: m × m ≻ 0
  Eigen::MatrixXd modelRate;   ///< on the rate of u: m × m ⪰ 0; empty: 0
  // the LQR that projects, on (x, u_k)
  Eigen::MatrixXd gainState;  ///< (n + m) × (n + m) ⪰ 0
  Eigen::MatrixXd gainInput;  ///< m × m ≻ 0
};

/// Optimises a motion by the projection operator in discrete time (chapter 5): every step map, any
/// parameters, exact derivatives of the extended system (5.1), so that DJ·ζ is the derivative of
/// J(P(ξ + γζ)) to rounding.
///
/// u_k is carried as a state beside x_k, because a step may read the input at both of its ends; the
/// projection feeds back on (x, u_k), and ψ follows.
class StepProjection : public SearchProblem {
 public:
  /// Starts from the motion of `start` (inputs u_0 … u_K), or of the desired inputs.
  /// @throws std::invalid_argument, std::domain_error naming a broken rule: sizes, weights, limits
  ///   (lower < upper, weight > 0), a start that the map does not solve (with the time)
  /// @throws NoInformation where the start tells nothing about some combination
  StepProjection(ExtendedStepMap system, StepDesign design,
                 const std::vector<Eigen::VectorXd>& start = {});

  double cost() const override { return cost_; }
  const Eigen::MatrixXd& information() const override { return information_; }
  Direction findDirection(double repeatedTolerance) override;
  double trial(double step) override;
  void accept() override;

  const StepMotion& motion() const { return motion_; }
  /// What J would be without φ(I).
  double trackingCost() const;

 private:
  struct Evaluated {
    double cost;
    Eigen::MatrixXd information;
  };
  Evaluated evaluate(const StepMotion& motion) const;
  double tracking(const StepMotion& motion) const;
  std::size_t steps() const { return design_.desiredInput.size() - 1; }
  bool measured(std::size_t k) const { return k > 0 && k % design_.stepsPerSample == 0; }
  Eigen::VectorXd limitSlope(const Eigen::VectorXd& u) const;

  ExtendedStepMap system_;
  StepDesign design_;
  Eigen::MatrixXd inverseCovariance_;
  std::vector<Eigen::VectorXd> desiredState_;
  StepMotion motion_, tried_;
  double cost_, triedCost_;
  Eigen::MatrixXd information_, triedInformation_;
  std::vector<Eigen::MatrixXd> gains_;
  std::vector<Eigen::VectorXd> z_, v_;  ///< ζ
};

}  // namespace info
