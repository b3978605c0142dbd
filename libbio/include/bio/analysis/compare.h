#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bio/simulation/simulate.h"

/// Integrators at several time steps, compared with one converged motion.
namespace bio {

/// Difference between two motions, over all free rotations.
struct Deviation {
  double rms = 0;        ///< root mean square over rows and rotations [rad]
  double largest = 0;    ///< [rad]
  double largestAt = 0;  ///< [s]
};
/// Difference at the rows of `motion`; the reference is interpolated by cubics through values and
/// speeds. Rows outside the time range of the reference are left out.
/// @throws std::invalid_argument if no coordinate is a rotation, or no row is covered
Deviation sd(const MusculoskeletalSystem& system, const Trajectory& motion,
             const Trajectory& reference);

struct CompareOptions {
  std::vector<Integrator> integrators = {Integrator::rungeKutta4, Integrator::variational,
                                         Integrator::variationalLeft, Integrator::cvode};
  /// [s] > 0, rising; cvode: intervals of the output; vi-adaptive: these and the longest parts
  std::vector<double> steps = {0.0002, 0.0003, 0.0005, 0.0008, 0.001,
                               0.002,  0.005,  0.01,   0.02,   0.05};
  double startTime = 0;              ///< [s]
  double duration = 0;               ///< [s] > 0
  ExternalForce externalForce = {};  ///< empty: no external force
  PrescribedMotion prescribed = {};  ///< of the system's prescribed coordinates
  int timings = 5;  ///< least number of runs of each cell, whose median is reported; ≥ 1
  double usefulError = 0.017453293;  ///< RMS below which a step counts as stable [rad] > 0
  double stepResolution = 1.02;      ///< ratio at which the bisection for a step ends, > 1
  /// Called between runs with the fraction of the work done, 0 to 1.
  std::function<void(double)> progress;
};

/// The reference motion: CVODE at two tolerances a factor of ten apart, confirmed by the
/// variational integrator at a small step.
struct ConvergedReference {
  Trajectory motion;              ///< at the tighter tolerance
  double relativeTolerance = 0;   ///< the tighter one; absolute: a hundredth of it
  double looserTolerance = 0;     ///< relative
  Deviation problem;              ///< difference of the looser run
  double interpolationError = 0;  ///< RMS, between rows [rad]; from leaving out every second row
  double secondStep = 0;          ///< of the variational integrator, the last one tried [s]
  Deviation second;               ///< difference of its motion; NaN if it does not reach the end
  std::string whyDisputed;        ///< one line; empty if the two agree, or CVODE has no motion
  bool completed() const { return motion.outcome == Outcome::completed; }
  /// Whether both integrators agree to a twentieth of CompareOptions::usefulError (RMS).
  bool confirmed() const { return completed() && whyDisputed.empty(); }
  /// Accuracy to which errors are known [rad].
  double floor() const { return problem.rms + interpolationError; }
};

/// One integrator at one step. Values that are undefined because the run did not reach the end are
/// NaN. A run of rk4 that reaches the end with an RMS error of usefulError or more counts as
/// unstable: while it is stable its error is smaller by orders of magnitude.
struct CompareCell {
  Integrator integrator = Integrator::variational;
  double step = 0;  ///< [s]
  Outcome outcome = Outcome::completed;
  double failedAt = 0;       ///< [s]; NaN if completed
  std::string why;           ///< one line; empty if completed
  Deviation error;           ///< from the reference
  double wallSeconds = 0;    ///< median
  double newtonPerStep = 0;  ///< 0 for rk4
  double energyError = 0;    ///< energyError() of coupled.h [J]
  long halvedSteps = 0;
  std::vector<double> time;  ///< [s] as far as it came
  Eigen::MatrixXd q;         ///< one column per time
};

/// The largest step that is stable: the run reaches the end and its RMS error is below
/// CompareOptions::usefulError. The step is doubled or halved from 1 ms until the answer changes,
/// then bisected on a logarithmic scale; it is assumed that no shorter step fails. The criterion
/// includes the error because a stable motion can be wrong by tens of degrees.
struct StepLimit {
  Integrator integrator = Integrator::variational;
  double stable = 0;   ///< [s] the largest found; NaN if none
  double failing = 0;  ///< [s] the smallest found; NaN if a quarter of the duration is still stable
  std::string why;     ///< why the smallest failing step failed, one line
};

/// Order p of an error ∝ stepᵖ.
struct ObservedOrder {
  Integrator integrator = Integrator::variational;
  double order = 0;            ///< NaN if fewer than three steps remain
  std::vector<double> steps;   ///< [s] that the fit used
  std::vector<double> errors;  ///< RMS [rad] at these
};

/// Slope of log error over log step, least squares, over the errors above ten times `floor`:
/// smaller ones are dominated by the error of the reference. @throws std::invalid_argument sizes, a
/// step ≤ 0
ObservedOrder fitOrder(const std::vector<double>& steps, const std::vector<double>& errors,
                       double floor);

/// Steps over which an integrator's order is observed [s]: within its asymptotic range for motions
/// of seconds, and integer fractions of 5 ms (vi: or integer multiples), so that the corners of
/// recorded excitations lie on steps. Empty for those that choose their steps.
std::vector<double> orderSteps(Integrator integrator);

struct Comparison {
  ConvergedReference reference;
  std::vector<CompareCell> cells;     ///< by integrator, then by rising step
  std::vector<StepLimit> limits;      ///< of rk4, vi and vi-left as far as compared
  std::vector<ObservedOrder> orders;  ///< of the same
};

/// Runs every integrator at every step. A run that fails is a result; if the reference fails,
/// everything else is empty.
/// @throws std::invalid_argument an empty list or one with duplicates, steps that are not > 0 and
///   rising, and what simulate() throws
Comparison compareIntegrators(const MusculoskeletalSystem& system,
                              const ExcitationSignal& excitation, const SystemState& start,
                              const CompareOptions& options);

}  // namespace bio
