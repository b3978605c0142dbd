#include "robots/string_length.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>

namespace info::robot {
namespace {

void mustBePositive(const char* what, double value, const char* unit, bool mayBeZero = false) {
  if ((mayBeZero ? value >= 0 : value > 0) && std::isfinite(value)) return;
  throw std::invalid_argument(
      fmt::format("{}: {}{}, must be {} 0 and finite", what, value, unit, mayBeZero ? "≥" : ">"));
}

ActiveEstimationTask taskOf(const StringLengthRequest& request, double initialLength,
                            std::uint64_t stream) {
  ActiveEstimationTask task;
  task.initialLength = initialLength;
  task.trueLength = request.trueLength;
  task.trueMass = request.payload;
  task.initialMass = request.estimateMass ? 0.8 * request.payload : request.payload;
  task.estimateMass = request.estimateMass;
  task.duration = request.duration;
  task.seed = request.seed;
  task.stream = stream;
  task.cell.sd = request.noise;
  task.disturbance.acceleration = request.disturbance;
  task.trackingWeight *= request.trackingWeight / 20;
  task.modelClipping = !request.ignoreClipping;
  task.window = request.window;
  task.action.searchTime = request.searchTime;
  return task;
}

/// Swings on the true string, planned for another length.
SwingRun swingPlannedFor(double length, const StringLengthRequest& request) {
  try {
    return executeSwing(planSwing(length), request.trueLength, {}, {.start = 0}, request.payload);
  } catch (const std::domain_error& e) {
    SwingRun none{};
    none.crossingHeight = std::nan("");
    none.why = fmt::format("planning failed: {}", e.what());
    return none;
  }
}

ActiveEstimationResult learn(const StringLengthRequest& request, const ActiveEstimationTask& task,
                             double trialsDone, double trials) {
  if (!request.realTime) return runActiveEstimation(task);
  return runActiveEstimationInRealTime(task, [&](double time) {
    if (request.progress)
      request.progress("trials", (trialsDone + std::min(1.0, time / request.duration)) / trials);
    return true;
  });
}

void summarise(StringLengthResult& result, double trueLength) {
  double sum = 0;
  for (const StringLengthTrial& t : result.trials) {
    const double length = t.learnt.length();
    sum += length;
    result.largestError = std::max(result.largestError, std::abs(length - trueLength));
    result.clippedSamples += t.learnt.clippedSamples;
    result.successesWithout += t.withoutEstimation.success;
    result.successesWith += t.withEstimation.success;
    result.slack = result.slack || !(t.learnt.leastTension > 0);
  }
  const double n = static_cast<double>(result.trials.size());
  result.mean = sum / n;
  double squares = 0;
  for (const StringLengthTrial& t : result.trials)
    squares += std::pow(t.learnt.length() - result.mean, 2);
  result.sd = result.trials.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;
}

}  // namespace

StringLengthResult estimateStringLength(const StringLengthRequest& request) {
  mustBePositive("duration", request.duration, " s");
  mustBePositive("payload", request.payload, " kg");
  mustBePositive("true length", request.trueLength, " m");
  mustBePositive("noise", request.noise, " N");
  mustBePositive("disturbance", request.disturbance, " m/s²", true);
  mustBePositive("tracking weight", request.trackingWeight, "", true);
  const std::vector<double> lengths =
      request.initialLengths.empty() ? initialLengths() : request.initialLengths;
  StringLengthResult result;
  result.firstDecision = firstAction(taskOf(request, lengths.front(), 0)).why;
  if (result.firstDecision != ActionEnd::acts) return result;
  const auto n = static_cast<double>(lengths.size());
  for (const double length : lengths) {
    const auto done = static_cast<double>(result.trials.size());
    const ActiveEstimationTask task = taskOf(request, length, result.trials.size());
    result.trials.push_back({length, learn(request, task, done, n), {}, {}});
    if (request.progress) request.progress("trials", (done + 1) / n);
  }
  for (StringLengthTrial& trial : result.trials) {
    trial.withoutEstimation = swingPlannedFor(trial.initialLength, request);
    trial.withEstimation = swingPlannedFor(trial.learnt.length(), request);
    if (request.progress) request.progress("swings", 1);
  }
  summarise(result, request.trueLength);
  return result;
}

}  // namespace info::robot
