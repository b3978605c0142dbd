#pragma once

#include <Eigen/Dense>
#include <memory>
#include <optional>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "info/discovery/likelihood/latent_nodes.h"
#include "info/discovery/likelihood/whitening.h"

namespace info::discover {

class DampedSystem;
struct JointVector;

/// The noise model: how the data scatter about the model.
struct Noise {
  Whitening output;          ///< σ_y > 0 of each output
  double latent = 0;         ///< σ_d ≥ 0, size of the latent force in units of its scale G
  double latentTime = 0.08;  ///< ℓ [s] > 0, correlation time of the latent force
};

/// A hypothesis fitted to the trials: the most probable parameters, initial states and latent
/// forces, either jointly (Likelihood::fit) or with the latent forces marginalised
/// (Likelihood::marginal).
struct Fit {
  Hypothesis hypothesis;
  Noise noise;
  Eigen::VectorXd values;  ///< of all quantities
  Eigen::VectorXd xi;      ///< of the free quantities, prior N(0, 1)
  std::vector<Eigen::VectorXd>
      eta;                     ///< latent force of each trial, prior N(0, 1); empty if σ_d = 0
  double cost = 0;             ///< J = ½|e|² + ½|ξ|² + ½|η|²
  double logEvidence = 0;      ///< log Z
  Eigen::MatrixXd covariance;  ///< of ξ; 0 for those at a bound
  std::vector<bool> atBound;
  double latentNormSquared = 0;    ///< |η|²
  double effectiveParameters = 0;  ///< γ: effective number of the η that the data determine
  bool converged = false;
  int iterations = 0;

  double sd(std::size_t free) const;  ///< standard deviation of a free quantity's value
};

struct FitOptions {
  int iterations = 15;
  double tolerance = 0.02;    ///< [nats] converged if a further step would gain less
  Eigen::VectorXd tilt = {};  ///< c: the minimised function is J + cᵀξ; empty: 0
};

/// Gaussian likelihood of whole trials: docs/decisions/030-latent-force-likelihood.md.
///
/// The latent force is d = σ_d·L·η at its nodes, LLᵀ = (GGᵀ)∘κ(|t_a−t_b|) over the nodes a of
/// all axes (latentCovariance), η ~ N(0, 1). All unknowns are then N(0, 1) a priori. Samples are
/// whitened on entry: residuals e = (ỹ − y(ξ, η))/σ and their derivatives Γ = −de/d(ξ, η) are in
/// standard deviations of the output of each sample.
///     J = ½|e|² + ½|ξ|² + ½|η|²
///     log Z = −J − ½ log|H| − Σ log(σ√2π),   H = 1 + ΓᵀΓ over (ξ, η)
/// where bounds truncate the normal distributions. For a linear model without bounds log Z is
/// exactly the sum of a Kalman filter's innovation terms.
class Likelihood {
 public:
  /// G is evaluated at `values` and held: hypotheses are compared under one noise model.
  /// @throws std::invalid_argument if the data break a rule of DiscoveryProblem
  Likelihood(const DiscoveryProblem& data, std::vector<int> trials, const Eigen::VectorXd& values,
             double latentTime = 0.08);

  const DiscoveryProblem& data() const { return data_; }
  const std::vector<int>& trials() const { return trials_; }
  Eigen::Index samples() const;

  /// Minimises J, starting from `start` (all quantities) and the latent forces `eta` (empty: 0).
  /// @throws std::domain_error if the model cannot be simulated at the start
  Fit fit(const Hypothesis& hypothesis, const Noise& noise, const Eigen::VectorXd& start,
          const std::vector<Eigen::VectorXd>& eta = {}, const FitOptions& options = {}) const;
  /// The fit; empty if the model cannot be simulated at the start.
  std::optional<Fit> tryFit(const Hypothesis& hypothesis, const Noise& noise,
                            const Eigen::VectorXd& start,
                            const std::vector<Eigen::VectorXd>& eta = {},
                            const FitOptions& options = {}) const;

  /// The fit at the parameters that are most probable after marginalisation over the latent
  /// forces, for the hypothesis of `near`: the minimum over ξ of
  ///     min_η J + ½ log|H_ηη(ξ)|,   H_ηη = 1 + WᵀW,   W = dy/dη/σ
  /// and the latent forces at that ξ. The joint fit lacks the second term, which is larger where
  /// latent forces have a larger effect on the outputs. It therefore underestimates damping,
  /// because small latent forces then suffice (docs/decisions/042-marginal-mode.md).
  ///
  /// The gradient of that term is evaluated at `near` and fixed; a second call with the result as
  /// `near` improves it. Returns `near` if there is no latent force, if the simulation fails, or if
  /// the result has less evidence.
  Fit marginal(const Fit& near) const;

  /// A trial at a fit. `outputs`, `speeds` and the course are in their own units, all
  /// else is divided by the σ of each sample's output.
  struct Linear {
    Eigen::VectorXd residuals;        ///< e = (ỹ − y)/σ
    Eigen::MatrixXd gamma;            ///< dy/dξ/σ
    Eigen::MatrixXd latent;           ///< dy/dη/σ
    Eigen::MatrixXd extra;            ///< dy/dq/σ of the further quantities
    Eigen::MatrixXd force;            ///< dy/dd/σ
    Eigen::VectorXd outputs;          ///< y
    Eigen::VectorXd speeds;           ///< ẏ
    DiscoveryProblem::Course course;  ///< only with η or `force`, likewise
    Eigen::MatrixXd courseByNode;     ///< ∂q/∂d
  };
  /// @param at    in the order of trials()
  /// @param extra further quantities, at their values in `values`
  Linear linearise(std::size_t at, const Fit& fit, const Eigen::VectorXd& values,
                   const std::vector<std::size_t>& extra, bool force) const;

  /// Score and information of further disturbances of the whitened outputs, per trial samples ×
  /// disturbances, after elimination of all quantities that are free in the fit and not at a bound.
  struct Projected {
    Eigen::VectorXd score;
    Eigen::MatrixXd information;
  };
  Projected project(const Fit& fit, const std::vector<Linear>& trials,
                    const std::vector<Eigen::MatrixXd>& disturbances) const;

  /// Whitened residuals (white for known ξ) in the order of time, with LLᵀ = 1 + WWᵀ. With ξ
  /// fitted the innovations' covariance is 1 − (L⁻¹Γ) cov(ξ) (L⁻¹Γ)ᵀ.
  struct Whitened {
    Eigen::VectorXd innovations;  ///< L⁻¹(e + Wη)
    Eigen::MatrixXd gamma;        ///< L⁻¹Γ
  };
  Whitened whitened(std::size_t at, const Fit& fit) const;

  /// Latent force at its nodes [unit of the generalised force], and its posterior standard
  /// deviation.
  Eigen::VectorXd force(std::size_t at, const Fit& fit) const;
  Eigen::VectorXd forceSd(std::size_t at, const Fit& fit) const;

  /// Root mean square of (ỹ − y)/σ without latent force over all trials, times the σ of the first
  /// output: in its unit. Of one output, the root mean square of ỹ − y.
  double simulationError(const Eigen::VectorXd& values, const Whitening& noise) const;

 private:
  struct Point;
  struct Normal;
  struct Step;
  class JointMinimisation;
  static double cost(const Point& point, double squares);
  void whiten(std::size_t at, const Noise& noise, Eigen::VectorXd& samples) const;
  double simulatedCost(const Noise& noise, const Point& point) const;
  static Normal normalEquations(const std::vector<Linear>& trials, const Point& point);
  static Point moved(const Hypothesis& hypothesis, const Point& from, const JointVector& move,
                     double share);
  Step step(const Hypothesis& hypothesis, const Normal& normal, const DampedSystem& system,
            const Point& point) const;
  void bend(Step& step, const Hypothesis& hypothesis, const Noise& noise,
            const std::vector<Linear>& trials, const DampedSystem& system,
            const Point& point) const;
  Eigen::VectorXd latentForce(std::size_t at, const Noise& noise, const Eigen::VectorXd& eta) const;
  Linear linearise(std::size_t at, const Hypothesis& hypothesis, const Noise& noise,
                   const Eigen::VectorXd& values, const Eigen::VectorXd& xi,
                   const Eigen::VectorXd& eta, const std::vector<std::size_t>& extra,
                   bool force) const;
  Linear linearOf(std::size_t at, const Hypothesis& hypothesis, const Noise& noise,
                  const Eigen::VectorXd& xi, DiscoveryProblem::Prediction prediction, bool latent,
                  bool force) const;
  std::unique_ptr<DiscoveryProblem::Simulation> simulated(std::size_t at,
                                                          const Hypothesis& hypothesis,
                                                          const Noise& noise,
                                                          const Point& point) const;
  void finish(Fit& fit, const std::vector<Linear>& trials, const Eigen::VectorXd& tilt) const;
  Eigen::VectorXd logDeterminantSlope(const Fit& fit) const;

  const DiscoveryProblem& data_;
  std::vector<int> trials_;
  std::vector<Eigen::MatrixXd> roots_;  ///< L per trial
};

}  // namespace info::discover
