#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robots/active_estimation.h"
#include "robots/box_task.h"
#include "robots/robot_work.h"

/// A robot arm estimates the length of a string while it moves, and then swings the ball on it into
/// a box: chapter 6 of Wilson's thesis.
namespace info::robot {

/// Trials from several initial estimates of the length.
struct StringLengthRequest {
  bool realTime = false;                    ///< four threads at their own rates, not simulated time
  double duration = 6;                      ///< of a trial [s] > 0
  std::vector<double> initialLengths = {};  ///< [m]; empty: the nine of chapter 6
  double payload = 0.2;                     ///< [kg] > 0
  double trueLength = 0.368;                ///< [m] > 0
  double noise = 0.1;                       ///< of the load cell [N] > 0
  double disturbance = 0.5;    ///< unmeasured acceleration of the string's top [m/s²] ≥ 0
  double trackingWeight = 20;  ///< of the gripper's position, ≥ 0
  double window = 0;           ///< of the estimation [s]; 0: growing
  bool estimateMass = false, ignoreClipping = false, searchTime = false;
  std::uint64_t seed = 1;
  WorkProgress progress = {};
};

/// One trial, and the task carried out without and with the estimate.
struct StringLengthTrial {
  double initialLength;  ///< [m]
  ActiveEstimationResult learnt;
  SwingRun withoutEstimation, withEstimation;
};

struct StringLengthResult {
  std::vector<StringLengthTrial> trials;  ///< empty if nothing would move
  ActionEnd firstDecision =
      ActionEnd::notFinite;  ///< of the first trial; the arm moves if it `acts`

  // over all trials
  double mean = 0;          ///< of the estimates [m]
  double sd = 0;            ///< of them [m]; 0 for one
  double largestError = 0;  ///< [m]
  std::size_t successesWithout = 0, successesWith = 0, clippedSamples = 0;
  bool slack = false;  ///< the string was slack for a moment, where the model is not valid
};

/// All trials one after the other, since timings of a controller must not be those of its
/// neighbours, then the task with both lengths on the true string.
/// @throws std::domain_error, std::invalid_argument naming the violated rule
StringLengthResult estimateStringLength(const StringLengthRequest& request);

}  // namespace info::robot
