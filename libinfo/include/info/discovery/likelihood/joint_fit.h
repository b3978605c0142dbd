#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/hypothesis.h"

namespace info::discover {

class DampedSystem;
struct JointVector;

/// How the data scatter about the model.
struct Noise {
  double output = 0;         ///< σ_y > 0, of every sample
  double latent = 0;         ///< σ_d ≥ 0, of the latent force in units of its scale G
  double latentTime = 0.08;  ///< ℓ [s] > 0: the latent force forgets itself within
};

/// A hypothesis fitted to the trials: the most probable parameters, starts and latent forces, of
/// all together (Likelihood::fit) or of the parameters by themselves (Likelihood::marginal).
struct Fit {
  Hypothesis hypothesis;
  Noise noise;
  Eigen::VectorXd values;  ///< of all quantities
  Eigen::VectorXd xi;      ///< of the free ones, prior N(0, 1)
  std::vector<Eigen::VectorXd>
      eta;                     ///< latent force of each trial, prior N(0, 1); empty if σ_d = 0
  double cost = 0;             ///< J = ½Σe²/σ_y² + ½|ξ|² + ½|η|²
  double logEvidence = 0;      ///< log Z
  Eigen::MatrixXd covariance;  ///< of ξ; 0 for those at a bound
  std::vector<bool> atBound;
  double latentNormSquared = 0;    ///< |η|²
  double effectiveParameters = 0;  ///< γ: how many of the η the data determine
  bool converged = false;
  int iterations = 0;

  double sd(std::size_t free) const;  ///< of a free quantity's value
};

struct FitOptions {
  int iterations = 15;
  double tolerance = 0.02;    ///< nats that another step may still gain
  Eigen::VectorXd tilt = {};  ///< c: what is minimised is J + cᵀξ; empty: 0
};

/// Correlation over an interval Δ [s] of an Ornstein–Uhlenbeck process of time constant ℓ behind a
/// lag τ:
///     κ(Δ) = (ℓ e^{−Δ/ℓ} − τ e^{−Δ/τ})/(ℓ − τ),   e^{−Δ/ℓ} for τ = 0
double latentCorrelation(double interval, double time, double lag);

/// Gaussian likelihood of whole trials: docs/decisions/030-latent-force-likelihood.md.
///
/// The latent force is d = σ_d·L·η at its nodes, LLᵀ = (GGᵀ)∘κ(|t_i−t_j|), η ~ N(0, 1). All
/// that is uncertain is then N(0, 1) before the data, and with residuals e = ỹ − y(ξ, η)
///     J = ½|e|²/σ_y² + ½|ξ|² + ½|η|²
///     log Z = −J − ½ log|H| − N·log(σ_y√2π),   H = 1 + ΓᵀΓ/σ_y² over (ξ, η)
/// where bounds cut the normal distributions off. For a linear model without bounds log Z is
/// exactly the sum of a Kalman filter's innovation terms.
class Likelihood {
 public:
  /// G is taken where `values` lie and stays: hypotheses are compared under one noise model.
  /// @throws std::invalid_argument if the data break a rule of DiscoveryProblem
  Likelihood(const DiscoveryProblem& data, std::vector<int> trials, const Eigen::VectorXd& values,
             double latentTime = 0.08);

  const DiscoveryProblem& data() const { return data_; }
  const std::vector<int>& trials() const { return trials_; }
  Eigen::Index samples() const;

  /// Starts at `start` (all quantities) and the latent forces `eta` (empty: 0), ends at a minimum
  /// of J.
  /// @throws std::domain_error if the model cannot be simulated at the start
  Fit fit(const Hypothesis& hypothesis, const Noise& noise, const Eigen::VectorXd& start,
          const std::vector<Eigen::VectorXd>& eta = {}, const FitOptions& options = {}) const;
  /// The same, and nothing where the model cannot be simulated at the start.
  std::optional<Fit> tryFit(const Hypothesis& hypothesis, const Noise& noise,
                            const Eigen::VectorXd& start,
                            const std::vector<Eigen::VectorXd>& eta = {},
                            const FitOptions& options = {}) const;

  /// The same hypothesis with the parameters most probable by themselves, whatever the latent
  /// forces are: the minimum over ξ of
  ///     min_η J + ½ log|H_ηη(ξ)|,   H_ηη = 1 + WᵀW/σ_y²,   W = dy/dη
  /// and the latent forces that go with them. A fit of all together lacks the second term, which is
  /// larger where latent forces move the model more: it prefers too little damping, so that small
  /// forces do, by two deviations at 5 % of EMG noise (docs/decisions/042-marginal-mode.md).
  ///
  /// That term's slope is taken where `near` is and held; what comes out is `near` of a second call
  /// that does better. `near` itself where there is no latent force, where the simulation fails,
  /// and where what comes out has less evidence.
  Fit marginal(const Fit& near) const;

  /// What the data say at a fit about further disturbances of the outputs.
  struct Linear {
    Eigen::VectorXd residuals;  ///< e = ỹ − y
    Eigen::MatrixXd gamma;      ///< dy/dξ
    Eigen::MatrixXd latent;     ///< dy/dη
    Eigen::MatrixXd extra;      ///< dy/dq of further quantities
    Eigen::MatrixXd force;      ///< dy/dd
    Eigen::VectorXd speeds;
  };
  /// @param at    in the order of trials()
  /// @param extra further quantities, at the values that `values` gives them
  Linear linearise(std::size_t at, const Fit& fit, const Eigen::VectorXd& values,
                   const std::vector<std::size_t>& extra, bool force) const;

  /// Score and information of further disturbances, per trial samples × disturbances, after
  /// elimination of all that is free in the fit (but for what is at a bound).
  struct Projected {
    Eigen::VectorXd score;
    Eigen::MatrixXd information;
  };
  Projected project(const Fit& fit, const std::vector<Linear>& trials,
                    const std::vector<Eigen::MatrixXd>& disturbances) const;

  /// What would be white if ξ were known, with LLᵀ = σ_y² + WWᵀ, in the order of time. With ξ
  /// fitted the innovations' covariance is 1 − (L⁻¹Γ) cov(ξ) (L⁻¹Γ)ᵀ.
  struct Whitened {
    Eigen::VectorXd innovations;  ///< L⁻¹(e + Wη)
    Eigen::MatrixXd gamma;        ///< L⁻¹Γ
  };
  Whitened whitened(std::size_t at, const Fit& fit) const;

  /// Latent force at its nodes [unit of the generalised force], and its posterior deviation.
  Eigen::VectorXd force(std::size_t at, const Fit& fit) const;
  Eigen::VectorXd forceSd(std::size_t at, const Fit& fit) const;

  /// Root mean square of ỹ − y without latent force over all trials.
  double simulationError(const Eigen::VectorXd& values) const;

 private:
  struct Point;
  struct Normal;
  struct Step;
  static double cost(const Noise& noise, const Point& point, double squares);
  double simulatedCost(const Noise& noise, const Point& point) const;
  Normal normalEquations(const std::vector<Linear>& trials, const Noise& noise,
                         const Point& point) const;
  static Point moved(const Hypothesis& hypothesis, const Point& from, const JointVector& move,
                     double share);
  Step step(const Hypothesis& hypothesis, const Normal& normal, const DampedSystem& system,
            const Point& point) const;
  void bend(Step& step, const Hypothesis& hypothesis, const Noise& noise,
            const std::vector<Linear>& trials, const DampedSystem& system,
            const Point& point) const;
  Eigen::VectorXd latentForce(std::size_t at, const Noise& noise, const Eigen::VectorXd& eta) const;
  Linear linearise(std::size_t at, const Hypothesis& hypothesis, double latentSize,
                   const Eigen::VectorXd& values, const Eigen::VectorXd& xi,
                   const Eigen::VectorXd& eta, const std::vector<std::size_t>& extra,
                   bool force) const;
  void finish(Fit& fit, const std::vector<Linear>& trials, const Eigen::VectorXd& tilt) const;
  Eigen::VectorXd logDeterminantSlope(const Fit& fit) const;

  const DiscoveryProblem& data_;
  std::vector<int> trials_;
  std::vector<Eigen::MatrixXd> roots_;  ///< L per trial
};

}  // namespace info::discover
