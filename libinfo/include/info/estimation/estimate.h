#pragma once

#include <Eigen/Dense>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "info/estimation/least_squares.h"

namespace info {

/// Optimisation methods; all of them keep θ within its bounds.
enum class Method {
  gradientDescent,  ///< d = −dβ/dθ (Algorithm 2.1, with the sign corrected); converges linearly
  iteratedLeastSquares,  ///< d = −(ΣΓᵀΣ⁻¹Γ)⁻¹ dβ/dθ (2.8); superlinear where residuals are small
  newtonRaphson,  ///< d = −(d²β/dθ²)⁻¹ dβ/dθ (2.11); quadratic; needs second derivatives
  levenbergMarquardt  ///< damped iterated least squares; for poor starting values and weak
                      ///< information
};

/// Reason for the end of an estimation. The first five are convergence.
enum class Termination {
  gradientSmall,    ///< |dβ/dθ_i| of free parameters, in units of their own deviations
  decrementSmall,   ///< a full further step would lower β by at most `decrementTolerance`
  costSmall,        ///< β ≤ costTolerance
  roundingReached,  ///< no step lowers β, and the predicted decrease is below the rounding error of
                    ///< β
  kinkReached,  ///< no step lowers β, and the gradient is within `kinkTolerance`
  stepSmall,    ///< θ no longer changes, to rounding
  noDescent,    ///< no step along the direction lowers β enough
  singular,     ///< the (approximate) Hessian of free parameters cannot be inverted
  iterationLimit,
  stopped  ///< stopped by the progress callback
};

/// The reason as one line of text.
std::string describe(Termination why);

/// State of an estimation after an iteration.
struct EstimateProgress {
  int iteration;
  double cost;
  const Eigen::VectorXd& parameters;
};

struct EstimateOptions {
  Method method = Method::levenbergMarquardt;
  int maxIterations = 100;
  /// gradientSmall at max_i |dβ/dθ_i|/√I_ii ≤ this: the remaining change of a single parameter, in
  /// standard deviations.
  double gradientTolerance = 1e-8;
  /// decrementSmall at −½ gᵀd ≤ this [nats of log posterior]; 0: off. Not for gradient descent.
  double decrementTolerance = 1e-12;
  double costTolerance = 0;  ///< costSmall at β ≤ this; 0: off
  /// kinkReached if no step lowers β and max_i |dβ/dθ_i|/√I_ii ≤ this: the minimum of β may be at a
  /// kink of the model, where the gradient does not vanish; 0: off.
  double kinkTolerance = 0;
  double armijoSlope =
      1e-4;  ///< a step γd is accepted if β decreases by this fraction of −γ·gᵀd, in (0, 1)
  double armijoShrink = 0.5;  ///< factor by which γ is reduced until then, in (0, 1)
  double confidence = 0.95;   ///< confidence level of the intervals, in (0, 1)
  /// Called after every iteration; returning false stops.
  std::function<bool(const EstimateProgress&)> progress = {};
};

/// The result of an estimation. covariance is the Cramér–Rao bound at the estimate, priors
/// included.
struct Estimate {
  Eigen::VectorXd parameters;
  double cost = 0;           ///< β
  Eigen::VectorXd gradient;  ///< dβ/dθ
  Termination why = Termination::iterationLimit;
  bool converged = false;
  int iterations = 0;               ///< steps taken
  int evaluations = 0;              ///< number of predictions, with and without sensitivities
  int indefiniteHessians = 0;       ///< Newton–Raphson: steps that used |eigenvalues| instead
  std::vector<double> costHistory;  ///< β at the start and after each iteration
  std::vector<Eigen::VectorXd> parameterHistory;  ///< θ likewise
  Eigen::MatrixXd information;                    ///< ΣΓᵀΣ⁻¹Γ + 1/σ² at the estimate
  Eigen::MatrixXd covariance;  ///< its inverse: 0 for fixed parameters, +∞ and NaN where singular
  Eigen::MatrixX2d intervals;  ///< lower and upper end, clipped to the bounds
  std::vector<bool> atBound;   ///< θ_i is at a bound: its interval is not reliable
  double reducedChiSquare =
      0;  ///< 2β/(observations − parameters + priors); near 1 if model and Σ fit
};

/// Minimises β(θ) within bounds.
///
/// Every method changes only the free parameters: those that are neither fixed nor at a bound with
/// −dβ/dθ pointing outwards. Trial points are projected onto the bounds. The first three backtrack
/// by Armijo's rule from γ = 1 (gradient descent: from four times the last γ, at first 1). If the
/// exact Hessian is not positive definite, Newton–Raphson uses the absolute values of its
/// eigenvalues, and counts the case. Levenberg–Marquardt damps with λ·diag(ΣΓᵀΣ⁻¹Γ + 1/σ²) and
/// follows Nielsen's rule for λ. Not converging is a result, not an error.
///
/// @throws std::domain_error if the prediction at the start is not finite, or if a free parameter
/// without
///         prior changes no predicted sample there (zero information; named)
/// @throws std::invalid_argument if an option is out of range, or if Newton–Raphson is asked of a
///         predictor without second derivatives
Estimate estimate(const LeastSquares& problem, const EstimateOptions& options = {});
Estimate estimate(const LeastSquares& problem, const Eigen::VectorXd& start,
                  const EstimateOptions& options);
/// The result of estimate() for further searches, whose failure must not end what was found
/// already: nothing where estimate() throws std::domain_error.
std::optional<Estimate> estimateIfDefined(const LeastSquares& problem, const Eigen::VectorXd& start,
                                          const EstimateOptions& options);

/// The two-sided quantile z of the standard normal distribution: P(|Z| ≤ z) = confidence, in (0,
/// 1).
double normalQuantile(double confidence);

}  // namespace info
