#pragma once

#include <vector>

#include "info/design/riccati.h"
#include "info/design/robust_design.h"

/// Common parts of the projections in discrete and in continuous time.
namespace info {

/// A motion at the times t_k = k·step with its sensitivities.
struct Motion {
  std::vector<Eigen::VectorXd> x;
  std::vector<Eigen::VectorXd> u;
  std::vector<Eigen::MatrixXd> psi;
};

/// The design of an information-optimal motion in discrete or continuous time. n, m, p are the
/// sizes of one system; for stacked candidates they are those of each candidate.
struct MotionDesign {
  Eigen::VectorXd x0;
  std::vector<Eigen::VectorXd> desiredInput;  ///< û at the times t_k; x̂ is the resulting motion

  InformationWeights information;
  RobustRule candidateRule = RobustRule::average;  ///< of stacked candidates
  Eigen::MatrixXd stateWeight;                     ///< Q: n × n ⪰ 0; empty: 0
  Eigen::MatrixXd inputWeight;                     ///< R: m × m ⪰ 0; empty: 0
  InputLimits limits;

  // The quadratic model ½|ζ|² that shapes the direction, and the LQR that projects. `modelState`
  // weights all states of the direction, `gainState` those that are fed back; see the derived
  // designs.
  Eigen::MatrixXd modelState;  ///< ⪰ 0
  Eigen::MatrixXd modelInput;  ///< m × m ≻ 0
  Eigen::MatrixXd gainState;   ///< ⪰ 0
  Eigen::MatrixXd gainInput;   ///< m × m ≻ 0
};

/// A motion and its cost J = tracking + φ(I) during a search.
class ProjectedMotion : public SearchProblem {
 public:
  double cost() const final { return current_.cost; }
  /// Information matrix of the first candidate.
  const Eigen::MatrixXd& information() const final { return current_.information.front(); }
  /// Information matrices of all candidates.
  const std::vector<Eigen::MatrixXd>& informations() const { return current_.information; }
  /// Information matrix of the first candidate accumulated up to each t_k.
  std::vector<Eigen::MatrixXd> informationOverTime() const;
  double trial(double step) final;
  void accept() final;

  const Motion& motion() const { return motion_; }
  /// J without φ(I).
  double trackingCost() const { return tracking(motion_); }

 protected:
  /// @param design validated, with every weight set
  ProjectedMotion(ExtendedOutput output, int candidates, const MotionDesign& design,
                  Eigen::MatrixXd inverseNoise);

  virtual double tracking(const Motion& motion) const = 0;
  /// Weight of ΓᵀΣ⁻¹Γ at t_k in I.
  virtual double share(std::size_t k) const = 0;
  /// P(ξ + step·ζ); false if the motion does not exist.
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
