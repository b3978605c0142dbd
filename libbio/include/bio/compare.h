#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bio/coupled.h"

/// Integrators at time steps, measured against one converged motion.
namespace bio {

/// How far a motion is from another one, over all free rotations.
struct Deviation {
  double rms = 0;        ///< root mean square over rows and rotations [rad]
  double largest = 0;    ///< [rad]
  double largestAt = 0;  ///< [s]
};
/// The deviation at the rows of `motion`; the reference is read between its rows by cubics through
/// values and speeds. Rows outside the reference's time are left out.
/// @throws std::invalid_argument if no coordinate is a rotation, or no row is covered
Deviation deviation(const Arm& arm, const Trajectory& motion, const Trajectory& reference);

struct CompareOptions {
  std::vector<Integrator> integrators = {Integrator::rungeKutta4, Integrator::variational,
                                         Integrator::variationalLeft, Integrator::cvode};
  /// [s] > 0, rising; cvode: intervals of the output
  std::vector<double> steps = {0.0002, 0.0003, 0.0005, 0.0008, 0.001,
                               0.002,  0.005,  0.01,   0.02,   0.05};
  double startTime = 0;              ///< [s]
  double duration = 0;               ///< [s] > 0
  ExternalForce externalForce = {};  ///< empty: nothing pushes from outside
  int timings = 5;  ///< runs of each cell at least, of which the median counts; ≥ 1
  double usefulError = 0.017453293;  ///< RMS below which a step counts as stable [rad] > 0
  double stepResolution = 1.02;      ///< ratio at which the bisection for a step ends, > 1
  /// Called between runs with the part of the work that is done, 0 to 1.
  std::function<void(double)> progress;
};

/// The motion that all others are measured against: CVODE at two tolerances a factor ten apart, and
/// confirmed by the variational integrator, which shares no step with it, at a small step.
struct ConvergedReference {
  Trajectory motion;              ///< at the tighter tolerance
  double relativeTolerance = 0;   ///< the tighter one; absolute: a hundredth of it
  double looserTolerance = 0;     ///< relative
  Deviation disagreement;         ///< of the looser run
  double interpolationError = 0;  ///< RMS, between rows [rad]; from leaving out every second row
  double secondStep = 0;          ///< of the variational integrator, the last one tried [s]
  Deviation second;               ///< of its motion; NaN if that does not reach the end
  std::string whyDisputed;        ///< one line; empty if the two agree, or CVODE has no motion
  bool completed() const { return motion.outcome == Outcome::completed; }
  /// Two integrators that come to one motion: to a twentieth of CompareOptions::usefulError (RMS).
  bool confirmed() const { return completed() && whyDisputed.empty(); }
  /// Errors are not known better than this [rad].
  double floor() const { return disagreement.rms + interpolationError; }
};

/// One integrator at one step. What is not known of a run that did not reach the end is NaN.
/// A run of rk4 that reaches the end with an RMS error of usefulError or more counts as unstable:
/// as long as it is stable its error is smaller by orders of magnitude.
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
/// CompareOptions::usefulError. Doubled or halved from 1 ms until the answer changes, then bisected
/// in the logarithm; that no step in between fails is taken for granted. Stability alone would
/// flatter: a bounded motion can be wrong by tens of degrees.
struct StepLimit {
  Integrator integrator = Integrator::variational;
  double stable = 0;   ///< [s] the largest found; NaN if none
  double failing = 0;  ///< [s] the smallest found; NaN if a quarter of the duration is still stable
  std::string why;     ///< how the failing one failed, one line
};

/// Order p of an error ∝ stepᵖ.
struct ObservedOrder {
  Integrator integrator = Integrator::variational;
  double order = 0;            ///< NaN if fewer than three steps are left
  std::vector<double> steps;   ///< [s] that the fit used
  std::vector<double> errors;  ///< RMS [rad] at these
};

/// Slope of log error over log step, least squares, over the errors above ten times `floor`: finer
/// ones measure the reference. @throws std::invalid_argument sizes, a step ≤ 0
ObservedOrder fitOrder(const std::vector<double>& steps, const std::vector<double>& errors,
                       double floor);

/// Steps over which an integrator's order is observed [s]: in its asymptotic range on an arm's
/// motions of seconds, and whole parts of 5 ms (vi: or whole multiples), where recorded excitations
/// have their corners. Empty for cvode.
std::vector<double> orderSteps(Integrator integrator);

struct Comparison {
  ConvergedReference reference;
  std::vector<CompareCell> cells;     ///< integrator by integrator, steps rising
  std::vector<StepLimit> limits;      ///< of rk4 and the variational integrators compared
  std::vector<ObservedOrder> orders;  ///< of the same
};

/// Runs every integrator at every step. A run that fails is a result; if the reference fails,
/// everything else is empty.
/// @throws std::invalid_argument an empty or doubled list, steps that are not > 0 and rising, and
///   what simulate() throws
Comparison compareIntegrators(const Arm& arm, const ExcitationSignal& excitation,
                              const ArmState& start, const CompareOptions& options);

}  // namespace bio
