#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "info/estimation/least_squares.h"

namespace info {

/// How the next estimate is sought; θ is held within its bounds by all of them.
enum class Method {
  gradientDescent,  ///< d = −dβ/dθ (Algorithm 2.1, with the sign corrected); converges linearly
  iteratedLeastSquares,  ///< d = −(ΣΓᵀΣ⁻¹Γ)⁻¹ dβ/dθ (2.8); superlinear where residuals are small
  newtonRaphson,  ///< d = −(d²β/dθ²)⁻¹ dβ/dθ (2.11); quadratic; needs second derivatives
  levenbergMarquardt  ///< iterated least squares, damped; for far starts and weak information
};

/// Why an estimator stopped. The first five are convergence.
enum class Termination {
  gradientSmall,    ///< |dβ/dθ_i| of free parameters, in units of their own deviations
  decrementSmall,   ///< a whole further step would lower β by no more than `decrementTolerance`
  costSmall,        ///< β ≤ costTolerance
  roundingReached,  ///< no step lowers β, and what the gradient promises is below β's rounding
  kinkReached,      ///< no step lowers β, and the gradient is within `kinkTolerance`
  stepSmall,        ///< θ no longer moves, to rounding
  noDescent,        ///< no step along the direction lowers β enough
  singular,         ///< the (approximate) Hessian of free parameters cannot be inverted
  iterationLimit,
  stopped  ///< the progress callback said so
};

/// One line that says it in words.
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
  /// gradientSmall at max_i |dβ/dθ_i|/√I_ii ≤ this: how far a parameter alone would still move, in
  /// standard deviations.
  double gradientTolerance = 1e-8;
  /// decrementSmall at −½ gᵀd ≤ this [nats of log posterior]; 0: off. Not for gradient descent.
  double decrementTolerance = 1e-12;
  double costTolerance = 0;  ///< costSmall at β ≤ this; 0: off
  /// kinkReached where no step lowers β and max_i |dβ/dθ_i|/√I_ii ≤ this: β may have its minimum at
  /// a kink of the model, where no gradient vanishes; 0: off.
  double kinkTolerance = 0;
  double armijoSlope = 1e-4;  ///< a step γd is taken if β falls by this share of −γ·gᵀd, in (0, 1)
  double armijoShrink = 0.5;  ///< γ is multiplied by this until then, in (0, 1)
  double confidence = 0.95;   ///< of the intervals, in (0, 1)
  /// Called after every iteration; returning false stops.
  std::function<bool(const EstimateProgress&)> progress = {};
};

/// What an estimation found. covariance is the Cramér–Rao bound at the estimate, priors included.
struct Estimate {
  Eigen::VectorXd parameters;
  double cost = 0;           ///< β
  Eigen::VectorXd gradient;  ///< dβ/dθ
  Termination why = Termination::iterationLimit;
  bool converged = false;
  int iterations = 0;               ///< steps taken
  int evaluations = 0;              ///< predictions computed, with and without sensitivities
  int indefiniteHessians = 0;       ///< Newton–Raphson: steps that used |eigenvalues| instead
  std::vector<double> costHistory;  ///< β at the start and after each iteration
  std::vector<Eigen::VectorXd> parameterHistory;  ///< θ likewise
  Eigen::MatrixXd information;                    ///< ΣΓᵀΣ⁻¹Γ + 1/σ² at the estimate
  Eigen::MatrixXd covariance;  ///< its inverse: 0 where held fixed, +∞ and NaN where singular
  Eigen::MatrixX2d intervals;  ///< lower and upper end, clipped to the bounds
  std::vector<bool> atBound;   ///< θ_i ends on a bound: its interval is not to be trusted
  double reducedChiSquare =
      0;  ///< 2β/(observations − parameters + priors); near 1 if model and Σ fit
};

/// Minimises β(θ) within bounds.
///
/// Every method uses the free parameters only: those not fixed, and not on a bound that −dβ/dθ
/// presses against. Trial points are projected on the bounds. The first three backtrack by Armijo's
/// rule from γ = 1 (gradient descent: from four times the last γ, 1 at first). Where the exact
/// Hessian is not positive definite, Newton–Raphson takes the absolute values of its eigenvalues,
/// and counts it. Levenberg–Marquardt damps with λ·diag(ΣΓᵀΣ⁻¹Γ + 1/σ²) and follows Nielsen's rule
/// for λ. Not converging is a result, not an error.
///
/// @throws std::domain_error if the prediction at the start is not finite, or if a free parameter
/// without
///         prior changes no predicted sample there (zero information; named)
/// @throws std::invalid_argument if an option is out of range, or if Newton–Raphson is asked of a
///         predictor without second derivatives
Estimate estimate(const LeastSquares& problem, const EstimateOptions& options = {});
Estimate estimate(const LeastSquares& problem, const Eigen::VectorXd& start,
                  const EstimateOptions& options);

/// The two-sided quantile z of the standard normal distribution: P(|Z| ≤ z) = confidence, in (0,
/// 1).
double normalQuantile(double confidence);

}  // namespace info
