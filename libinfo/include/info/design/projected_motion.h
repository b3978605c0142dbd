#pragma once

#include <vector>

#include "info/design/riccati.h"
#include "info/design/robust_design.h"

/// What the projections in discrete and in continuous time share.
namespace info {

/// A motion at the times t_k = k·step with its sensitivities.
struct Motion {
  std::vector<Eigen::VectorXd> x;
  std::vector<Eigen::VectorXd> u;
  std::vector<Eigen::MatrixXd> psi;
};

/// What an information-optimal motion is to be, whichever way of time. n, m, p are the sizes of one
/// system; of stacked candidates each takes these.
struct MotionDesign {
  Eigen::VectorXd x0;
  std::vector<Eigen::VectorXd> desiredInput;  ///< û at the times t_k; x̂ is the motion they give

  InformationWeights information;
  RobustRule candidateRule = RobustRule::average;  ///< of stacked candidates
  Eigen::MatrixXd stateWeight;                     ///< Q: n × n ⪰ 0; empty: 0
  Eigen::MatrixXd inputWeight;                     ///< R: m × m ⪰ 0; empty: 0
  InputLimits limits;

  // The quadratic model ½|ζ|² that shapes the direction, and the LQR that projects. `modelState` is
  // on all states of the direction, `gainState` on those fed back; each way of time says which.
  Eigen::MatrixXd modelState;  ///< ⪰ 0
  Eigen::MatrixXd modelInput;  ///< m × m ≻ 0
  Eigen::MatrixXd gainState;   ///< ⪰ 0
  Eigen::MatrixXd gainInput;   ///< m × m ≻ 0
};

/// A motion and its cost J = tracking + φ(I), as the search moves it.
class ProjectedMotion : public SearchProblem {
 public:
  double cost() const final { return current_.cost; }
  /// I of the first candidate.
  const Eigen::MatrixXd& information() const final { return current_.information.front(); }
  /// I of every candidate.
  const std::vector<Eigen::MatrixXd>& informations() const { return current_.information; }
  /// What I of the first candidate has grown to at each t_k.
  std::vector<Eigen::MatrixXd> informationOverTime() const;
  double trial(double step) final;
  void accept() final;

  const Motion& motion() const { return motion_; }
  /// What J would be without φ(I).
  double trackingCost() const { return tracking(motion_); }

 protected:
  /// @param design checked, with every weight filled in
  ProjectedMotion(ExtendedOutput output, int candidates, const MotionDesign& design,
                  Eigen::MatrixXd inverseNoise);

  virtual double tracking(const Motion& motion) const = 0;
  /// How much ΓᵀΣ⁻¹Γ at t_k counts in I.
  virtual double share(std::size_t k) const = 0;
  /// P(ξ + step·ζ); false if there is no such motion.
  virtual bool project(double step, Motion& motion) const = 0;

  /// Makes a motion the current one.
  void begin(Motion motion);
  /// dφ/dI of every candidate at the current motion.
  std::vector<Eigen::MatrixXd> informationSlopes(double repeatedTolerance) const;
  /// The derivative of ⟨dφ/dI, ΓᵀΣ⁻¹Γ⟩ at t_k   (P8).
  ExtendedOutput::Gradient outputSlope(std::size_t k,
                                       const std::vector<Eigen::MatrixXd>& slopes) const;
  /// Keeps ζ.
  Direction follow(AffineLqSolution zeta);

  Motion motion_;
  std::vector<Eigen::MatrixXd> gains_;
  std::vector<Eigen::VectorXd> z_, v_;  ///< ζ

 private:
  struct Evaluated {
    double cost;
    std::vector<Eigen::MatrixXd> information;
  };
  Evaluated evaluate(const Motion& motion) const;
  /// ΓᵀΣ⁻¹Γ of a candidate, from the rows of all.
  Eigen::MatrixXd informationOf(const Eigen::MatrixXd& gamma, int candidate) const;

  ExtendedOutput output_;
  int candidates_;
  InformationWeights weights_;
  RobustRule rule_;
  Eigen::MatrixXd inverseNoise_;
  Motion tried_;
  Evaluated current_, triedEvaluated_;
};

}  // namespace info
