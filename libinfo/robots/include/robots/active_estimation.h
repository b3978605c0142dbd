#pragma once

#include <functional>
#include <vector>

#include "info/design/sequential_action_control.h"
#include "info/estimation/online_least_squares.h"
#include "info/realtime/periodic.h"
#include "robots/compliant_arm.h"

/// Chapter 6: an arm moves a mass on a string so that the force tells the string's length, and
/// learns it while it moves.
///
///     arm 1 kHz → readings → receiver 100 Hz → samples → estimator 2 Hz → estimate
///      ↑ command ←――――――――――――――――― controller 50 Hz, with the state observer ←―┘
namespace info {

/// A trial; the defaults are chapter 6's, or what it does not print.
struct ActiveEstimationTask {
  double initialLength = 0.45;  ///< ℓ at the start of the estimate [m] > 0
  double trueLength = 0.368;    ///< [m] > 0
  double trueMass = 0.2;        ///< [kg] > 0
  bool estimateMass = false;    ///< else it is known
  double initialMass = 0.2;     ///< [kg] > 0, where the mass is estimated
  double duration = 6;          ///< [s] > 0
  std::uint64_t seed = 1, stream = 0;

  SystemOptions arm;
  LoadCell cell;
  ArmDisturbance disturbance;

  // the controller
  ActionOptions action;
  double largestInput = 6;                           ///< |u| ≤ [m/s²] > 0
  double inputWeight = 0.01;                         ///< R > 0
  double informationSd = 0.05;                       ///< σ in its cost [N] > 0
  double epsilon = 1e-2;                             ///< ε > 0
  Vector<double, 4> trackingWeight = {20, 0, 2, 0};  ///< diagonal of Q on (x, φ, ẋ, φ̇)
  double longestApplied = 0.04;                      ///< an action is applied so long [s]

  // the estimator
  bool modelClipping = true;  ///< false: a clipped sample counts as a measurement
  double lengthSd = 0.02;     ///< of the prior about the initial length [m] > 0
  double massSd = 0.05;       ///< likewise [kg]
  double window = 0;          ///< how far back it looks [s]; 0: to the start
};

/// The rates of the modules.
inline constexpr double kReceiverPeriod = 0.01, kControllerPeriod = 0.02, kEstimatorPeriod = 0.5;

/// A trial as it went.
struct ActiveEstimationResult {
  struct EstimateAt {
    double time, length, lengthSd, mass, massSd;
    bool converged;
    int iterations;
  };
  struct SampleAt {
    SystemReading reading;
    double predictedForce;  ///< by the observer, at the estimate of that time [N]
    double information;     ///< about the length, so far [1/m²]
  };
  std::vector<EstimateAt> estimates;  ///< first: the initial one
  std::vector<SampleAt> samples;
  std::size_t clippedSamples = 0;
  std::size_t actions = 0;  ///< control cycles that acted
  std::size_t idle = 0;     ///< that saw nothing to gain
  double leastTension = 0;  ///< [N]; ≤ 0: the string was slack and the model is no model of it
  ActionEnd firstDecision = ActionEnd::notFinite;
  DeadlineReport controller, receiver, estimator, armLoop;
  std::vector<double> cycleSeconds;  ///< of the controller
  bool realTimePriority = false;
  double length() const { return estimates.back().length; }
};

/// One thread, simulated time: the same bits every time.
/// @throws std::domain_error, std::invalid_argument naming a broken rule
ActiveEstimationResult runActiveEstimation(const ActiveEstimationTask& task);

/// Four threads at their own rates in real time: takes task.duration. Deadlines are reported.
/// @param keepGoing asked about 20 times a second; false ends the trial, and so does an exception
///   of its own, which is passed on
ActiveEstimationResult runActiveEstimationInRealTime(
    const ActiveEstimationTask& task, const std::function<bool(double time)>& keepGoing = {});

/// What the controller would do first, before anything is run.
Action<1> firstAction(const ActiveEstimationTask& task);

/// The nine lengths that trials start from, 0.308 … 0.468 m.
std::vector<double> initialLengths();

}  // namespace info
