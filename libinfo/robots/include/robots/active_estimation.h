#pragma once

#include <functional>
#include <vector>

#include "info/design/sequential_action_control.h"
#include "info/dynamics/online_least_squares.h"
#include "info/realtime/periodic.h"
#include "robots/compliant_arm.h"

/// Chapter 6 of Wilson's thesis: a robot arm moves a mass on a string such that the measured force
/// is informative about the string's length, which is estimated during the motion.
///
///     arm 1 kHz → readings → receiver 100 Hz → samples → estimator 2 Hz → estimate
///      ↑ command ←――――――――――――――――― controller 50 Hz, with the state observer ←―┘
namespace info {

/// Options of a trial; the defaults are those of chapter 6, or chosen where it gives none.
struct ActiveEstimationTask {
  double initialLength = 0.45;  ///< initial estimate of ℓ [m] > 0
  double trueLength = 0.368;    ///< [m] > 0
  double trueMass = 0.2;        ///< [kg] > 0
  bool estimateMass = false;    ///< false: the mass is known
  double initialMass = 0.2;     ///< [kg] > 0, if the mass is estimated
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
  double longestApplied = 0.04;                      ///< longest duration of an action [s]

  // the estimator
  bool modelClipping = true;  ///< false: a clipped sample counts as a measurement
  double lengthSd = 0.02;     ///< prior standard deviation about the initial length [m] > 0
  double massSd = 0.05;       ///< likewise [kg]
  double window = 0;          ///< estimation window [s]; 0: from the start
};

/// The rates of the modules.
inline constexpr double kReceiverPeriod = 0.01, kControllerPeriod = 0.02, kEstimatorPeriod = 0.5;

/// The course of a trial.
struct ActiveEstimationResult {
  struct EstimateAt {
    double time, length, lengthSd, mass, massSd;
    bool converged;
    int iterations;
  };
  struct SampleAt {
    SystemReading reading;
    double predictedForce;  ///< by the observer, at the current estimate [N]
    double information;     ///< accumulated information about the length [1/m²]
  };
  std::vector<EstimateAt> estimates;  ///< the first is the initial one
  std::vector<SampleAt> samples;
  std::size_t clippedSamples = 0;
  std::size_t actions = 0;  ///< control cycles with an action
  std::size_t idle = 0;     ///< control cycles without an action
  double leastTension = 0;  ///< [N]; ≤ 0: the string was slack, and the model is not valid
  ActionEnd firstDecision = ActionEnd::notFinite;
  DeadlineReport controller, receiver, estimator, armLoop;
  std::vector<double> cycleSeconds;  ///< of the controller
  bool realTimePriority = false;
  double length() const { return estimates.back().length; }
};

/// One thread, simulated time: bitwise reproducible.
/// @throws std::domain_error, std::invalid_argument naming the violated rule
ActiveEstimationResult runActiveEstimation(const ActiveEstimationTask& task);

/// Four threads at their own rates in real time: takes task.duration. Deadlines are reported.
/// @param keepGoing called about 20 times a second; returning false ends the trial, and so does an
///   exception, which is rethrown
ActiveEstimationResult runActiveEstimationInRealTime(
    const ActiveEstimationTask& task, const std::function<bool(double time)>& keepGoing = {});

/// The first action of the controller, without running the trial.
Action<1> firstAction(const ActiveEstimationTask& task);

/// The nine initial lengths of the trials, 0.308 … 0.468 m.
std::vector<double> initialLengths();

}  // namespace info
