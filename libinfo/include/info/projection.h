#pragma once

#include <vector>

#include "info/extended_system.h"
#include "info/trajectory_search.h"

namespace info {

/// A motion at the nodes t_k = k·step of a grid.
struct FlowMotion {
  std::vector<Eigen::VectorXd> x;
  std::vector<Eigen::VectorXd> u;
  std::vector<Eigen::MatrixXd> psi;
};

/// What an information-optimal motion is to be. N = n + np.
///     J = ∫ ½|x − x̂|²_Q + ½|u − û|²_R dt + φ(I),   I = ∫ Γᵀ Σ⁻¹ Γ dt
/// Σ is here the noise's spectral density: a measurement at period τ with covariance C is Σ = C·τ,
/// and Σ = C makes I that of one sample a second, on which the weights of φ are relative.
struct FlowDesign {
  double step = 0;  ///< between nodes [s] > 0
  Eigen::VectorXd x0;
  std::vector<Eigen::VectorXd> desiredInput;  ///< û at the nodes; x̂ is the motion it gives
  Eigen::MatrixXd outputDensity;              ///< Σ [(output unit)² s]

  InformationWeights information;
  Eigen::MatrixXd stateWeight;  ///< Q: n × n ⪰ 0; empty: 0
  Eigen::MatrixXd inputWeight;  ///< R: m × m ⪰ 0; empty: 0
  InputLimits limits;

  Eigen::MatrixXd modelState;  ///< of the direction, on (x, vec ψ): N × N ⪰ 0
  Eigen::MatrixXd modelInput;  ///< likewise on u: m × m ≻ 0
  Eigen::MatrixXd gainState;   ///< of the LQR that projects: n × n ⪰ 0
  Eigen::MatrixXd gainInput;   ///< m × m ≻ 0
};

/// Optimises a motion by the projection operator in continuous time (chapter 4): any smooth system,
/// with the input in the output or not (B.1, with the term of u that it lacks).
///
/// The equations are those of continuous time, then put on a grid: x and ψ by Runge–Kutta of order
/// 4, Riccati likewise, integrals by the trapezoidal rule, everything linear between nodes. DJ·ζ is
/// therefore the derivative of J(P(ξ + γζ)) up to O(step²); discrete_projection.h has it exactly.
class FlowProjection : public SearchProblem {
 public:
  /// Starts from the motion of `start` (inputs at the nodes), or of the desired inputs.
  /// @throws as StepProjection
  FlowProjection(ExtendedFlow system, FlowDesign design,
                 const std::vector<Eigen::VectorXd>& start = {});

  double cost() const override { return cost_; }
  const Eigen::MatrixXd& information() const override { return information_; }
  Direction findDirection(double repeatedTolerance) override;
  double trial(double step) override;
  void accept() override;

  const FlowMotion& motion() const { return motion_; }
  /// What J would be without φ(I).
  double trackingCost() const;

 private:
  struct Evaluated {
    double cost;
    Eigen::MatrixXd information;
  };
  Evaluated evaluate(const FlowMotion& motion) const;
  double tracking(const FlowMotion& motion) const;
  std::size_t steps() const { return design_.desiredInput.size() - 1; }
  /// Weight of node k in the trapezoidal sum.
  double share(std::size_t k) const {
    return k == 0 || k == steps() ? 0.5 * design_.step : design_.step;
  }
  /// The closed loop u = β − K(x − α) from x0; without gains, u = β. False if it leaves the
  /// numbers.
  bool run(const std::vector<Eigen::VectorXd>& alpha, const std::vector<Eigen::VectorXd>& beta,
           const std::vector<Eigen::MatrixXd>& gains, FlowMotion& motion) const;

  ExtendedFlow system_;
  FlowDesign design_;
  Eigen::MatrixXd inverseDensity_;
  std::vector<Eigen::VectorXd> desiredState_;
  FlowMotion motion_, tried_;
  double cost_, triedCost_;
  Eigen::MatrixXd information_, triedInformation_;
  std::vector<Eigen::MatrixXd> gains_;
  std::vector<Eigen::VectorXd> z_, v_;  ///< ζ
};

}  // namespace info
