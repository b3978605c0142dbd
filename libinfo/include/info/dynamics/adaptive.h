#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

namespace info {

/// Tolerances and limits of an adaptive integration.
struct AdaptiveOptions {
  double relativeTolerance = 1e-8;   ///< of every component, > 0
  double absoluteTolerance = 1e-10;  ///< in the unit of each component, > 0
  double largestTimeStep = 0.0;  ///< [s] >= 0; 0: no limit. Set it below the shortest pulse of u
  long maxSteps = 100'000;       ///< > 0, between two requested times
};

/// A motion at the requested times.
struct AdaptiveTrajectory {
  std::vector<double> times;  ///< those reached [s]
  std::vector<Eigen::VectorXd> x;
  bool complete = true;      ///< false: stopped before the last requested time
  double reachedTime = 0.0;  ///< [s]
  std::string why;           ///< reason for an early stop; empty if complete
};

/// ẋ = field(t, x) for an x of run-time size, written to xDot.
using OdeField = std::function<void(double t, const double* x, double* xDot)>;

/// Solves ẋ = field(t, x) by variable-order, variable-step backward differentiation (BDF, CVODES of
/// SUNDIALS, the Jacobian by differences), with dense output at the requested times. Where the
/// field jumps, end one call at the jump and start the next there.
///
/// @param times t_0 < t_1 < … [s]; x0 belongs to t_0
/// @throws std::domain_error for tolerances that are not positive, times that do not increase or a
///     start that is not finite; whatever the field throws
AdaptiveTrajectory solveOde(const OdeField& field, const Eigen::VectorXd& x0,
                            const std::vector<double>& times, const AdaptiveOptions& options = {});

}  // namespace info
