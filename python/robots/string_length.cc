#include "robots/string_length.h"

#include <fmt/format.h>

#include "docstrings.h"
#include "info/design/sequential_action_control.h"
#include "interruptible.h"
#include "robots/robots.h"

namespace python {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using info::ActiveEstimationResult;

template <class Row, class Value>
VectorXd columnOf(const std::vector<Row>& rows, const Value& value) {
  VectorXd column(std::ssize(rows));
  for (Index k = 0; k < column.size(); ++k)
    column[k] = static_cast<double>(value(rows[static_cast<std::size_t>(k)]));
  return column;
}

py::object estimatesOf(const std::vector<ActiveEstimationResult::EstimateAt>& all) {
  const auto column = [&](auto value) { return columnOf(all, value); };
  std::vector<bool> converged;
  for (const auto& one : all) converged.push_back(one.converged);
  return results("time"_a = column([](const auto& e) { return e.time; }),
                 "length"_a = column([](const auto& e) { return e.length; }),
                 "length_sd"_a = column([](const auto& e) { return e.lengthSd; }),
                 "mass"_a = column([](const auto& e) { return e.mass; }),
                 "mass_sd"_a = column([](const auto& e) { return e.massSd; }),
                 "converged"_a = converged);
}

py::object samplesOf(const std::vector<ActiveEstimationResult::SampleAt>& all) {
  const auto column = [&](auto value) { return columnOf(all, value); };
  return results("time"_a = column([](const auto& s) { return s.reading.time; }),
                 "reference"_a = column([](const auto& s) { return s.reading.reference; }),
                 "position"_a = column([](const auto& s) { return s.reading.position; }),
                 "acceleration"_a = column([](const auto& s) { return s.reading.acceleration; }),
                 "force"_a = column([](const auto& s) { return s.reading.force; }),
                 "predicted_force"_a = column([](const auto& s) { return s.predictedForce; }),
                 "information"_a = column([](const auto& s) { return s.information; }));
}

py::object swingOf(const info::SwingRun& run) {
  const auto column = [](const std::vector<double>& values) {
    return VectorXd(VectorXd::Map(values.data(), std::ssize(values)));
  };
  return results("success"_a = run.success, "why"_a = run.why,
                 "crossing_height"_a = run.crossingHeight, "time"_a = column(run.time),
                 "gripper"_a = column(run.gripper), "ball_x"_a = column(run.ballX),
                 "ball_z"_a = column(run.ballZ));
}

py::object estimateStringLength(const std::vector<double>& initialLengths, double duration,
                                double payload, double trueLength, double noise, double disturbance,
                                double trackingWeight, double window, bool estimateMass,
                                bool ignoreClipping, bool searchTime, bool realTime,
                                std::uint64_t seed) {
  info::robot::StringLengthRequest request{.realTime = realTime,
                                           .duration = duration,
                                           .initialLengths = initialLengths,
                                           .payload = payload,
                                           .trueLength = trueLength,
                                           .noise = noise,
                                           .disturbance = disturbance,
                                           .trackingWeight = trackingWeight,
                                           .window = window,
                                           .estimateMass = estimateMass,
                                           .ignoreClipping = ignoreClipping,
                                           .searchTime = searchTime,
                                           .seed = seed,
                                           .progress = {}};
  info::robot::StringLengthResult found;
  interruptible([&](const std::atomic<bool>& goOn) {
    request.progress = whileTrue(goOn);
    found = info::robot::estimateStringLength(request);
  });
  if (found.trials.empty())
    throw std::invalid_argument(
        fmt::format("tracking_weight = {}: nothing would move ({}), since the load hangs at rest, "
                    "where the force does not depend on the string's length; must be > 0",
                    trackingWeight, info::describe(found.firstDecision)));
  py::list trials;
  for (const info::robot::StringLengthTrial& trial : found.trials)
    trials.append(results("initial_length"_a = trial.initialLength,
                          "length"_a = trial.learnt.length(),
                          "length_sd"_a = trial.learnt.estimates.back().lengthSd,
                          "mass"_a = trial.learnt.estimates.back().mass,
                          "estimates"_a = estimatesOf(trial.learnt.estimates),
                          "samples"_a = samplesOf(trial.learnt.samples),
                          "clipped_samples"_a = trial.learnt.clippedSamples,
                          "least_tension"_a = trial.learnt.leastTension,
                          "deadline_misses"_a = trial.learnt.controller.misses,
                          "swing_without"_a = swingOf(trial.withoutEstimation),
                          "swing_with"_a = swingOf(trial.withEstimation)));
  return results("trials"_a = trials, "mean"_a = found.mean, "sd"_a = found.sd,
                 "largest_error"_a = found.largestError,
                 "successes_without"_a = found.successesWithout,
                 "successes_with"_a = found.successesWith);
}

}  // namespace

void defineStringLength(py::module_& module) {
  const info::robot::StringLengthRequest usual;
  module.def("estimate_string_length", &estimateStringLength,
             "initial_lengths"_a = std::vector<double>(), py::kw_only(),
             "duration"_a = usual.duration, "payload"_a = usual.payload,
             "true_length"_a = usual.trueLength, "noise"_a = usual.noise,
             "disturbance"_a = usual.disturbance, "tracking_weight"_a = usual.trackingWeight,
             "window"_a = usual.window, "estimate_mass"_a = false, "ignore_clipping"_a = false,
             "search_time"_a = false, "real_time"_a = false, "seed"_a = 1,
             docstrings::estimate_string_length);
}

}  // namespace python
