#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "bio/calibration/calibrate_at_shorter_steps.h"
#include "bio/calibration/calibrated_model.h"
#include "bio/calibration/predicted_series.h"
#include "bio/tables/different_trials.h"
#include "docstrings.h"
#include "interruptible.h"
#include "systems.h"

namespace python {
namespace {

info::RobustLoss lossOf(const std::string& name) {
  info::RobustLoss loss;
  if (name == "gaussian") return loss;
  if (name != "huber" && name != "student") {
    throw std::invalid_argument(fmt::format("loss '{}', must be gaussian, huber or student", name));
  }
  loss.kind = name == "huber" ? info::RobustLoss::Kind::huber : info::RobustLoss::Kind::student;
  return loss;
}

/// None where it was not asked for, or has no interval.
py::object intervalOf(double lower, double upper) {
  if (std::isnan(lower) && std::isnan(upper)) return py::none();
  return py::make_tuple(lower, upper);
}

py::object estimateOf(const bio::CalibratedParameter& parameter) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  return results("value"_a = parameter.value, "sd"_a = parameter.sd, "lower"_a = parameter.lower,
                 "upper"_a = parameter.upper, "unit"_a = parameter.asked.unit,
                 "model"_a = parameter.model, "identifiable"_a = parameter.identifiable,
                 "at_bound"_a = parameter.atBound, "why"_a = parameter.why,
                 "profile"_a = parameter.profile
                                   ? intervalOf(parameter.profile->lower, parameter.profile->upper)
                                   : intervalOf(none, none),
                 "bootstrap"_a = intervalOf(parameter.bootstrapLower, parameter.bootstrapUpper));
}

/// [rad]; NaN without trials.
double rmse(const bio::TrialSet* set, const Eigen::MatrixXd& predicted) {
  return set && predicted.size() > 0 ? std::sqrt(set->meanSquare(predicted)) : NAN;
}

/// Predictions of every held-out series.
py::object predictionsOf(const bio::SteppedCalibration& stepped) {
  py::list list;
  if (!stepped.heldOut) return tableOfRows(list);
  const bio::TrialSet& heldOut = *stepped.heldOut;
  for (const bio::PredictedSeries& one : bio::predictedSeries(
           *stepped.training, heldOut, stepped.calibration, stepped.options.confidence)) {
    const bio::MeasuredSeries& series = heldOut.series()[one.series];
    const bio::MeasuredGroup& channel = heldOut.channels()[series.channel];
    list.append(results(
        "trial"_a = heldOut.trials()[series.trial].file, "channel"_a = bio::nameOf(series.what),
        "unit"_a = channel.areAngles ? "rad" : channel.unit, "peak_measured"_a = one.measuredPeak,
        "peak_predicted"_a = one.predictedPeak, "sd_of_estimates"_a = one.sdOfEstimates,
        "noise"_a = one.noise, "interval"_a = py::make_tuple(one.lower, one.upper),
        "holds_peak"_a = one.holdsPeak, "share_of_samples_held"_a = one.shareHeld));
  }
  return tableOfRows(list);
}

/// Latent excitations {muscle: (sd, distance of knots [s])} instead of what the trials say, if any.
std::vector<bio::Trial> declaring(std::vector<bio::Trial> trials, const Pairs& latent) {
  for (bio::Trial& trial : trials) {
    if (!latent.empty()) trial.latent.clear();
    for (const auto& [muscle, values] : latent) {
      trial.latent.push_back({muscle, values.first, values.second});
    }
  }
  return trials;
}

py::object calibrate(const bio::Model& model, const std::vector<bio::Trial>& trials,
                     const std::vector<std::string>& parameters,
                     const std::vector<bio::Trial>& holdOut, std::optional<double> noise,
                     const std::map<std::string, double>& channelNoise, bool priors,
                     const Pairs& prior, const Pairs& bounds, const std::string& loss,
                     bool ownStart, const Pairs& latent,
                     const std::map<std::string, double>& initial, int starts, std::uint64_t seed,
                     int threads, const std::vector<std::string>& profile, int bootstrap,
                     const py::object& progress, const Names& coordinate,
                     const std::map<std::string, double>& lock, const std::string& integrator,
                     std::optional<double> step) {
  const SystemChoice choice = systemChoice(model, trials, coordinate, lock, integrator, step);
  for (const auto* set : {&trials, &holdOut})
    for (const bio::Trial& trial : *set) mustBeOfTheModelAsItIs(trial);
  bio::requireDifferentTrials(trials, holdOut);
  bio::CalibrationOptions options;
  options.trials.parameters = parameters;
  options.trials.ownStart = ownStart;
  options.trials.latent = true;
  options.trials.initial = initial;
  options.trials.simulation = choice.simulation();
  options.trials.simulation.duration = 1;
  options.trials.threads = threads;
  options.priors = priors;
  for (const auto& [name, values] : prior) options.prior[name] = {values.first, values.second};
  options.bounds = bounds;
  options.noise = noise;
  options.channelNoise = channelNoise;
  options.profile = profile;
  options.bootstrap = bootstrap;
  options.loss = lossOf(loss);
  options.starts = starts;
  options.seed = seed;
  bio::SteppedCalibration stepped;
  interruptible({progress, "calibrate"}, [&](const auto& goOn, auto& done) {
    options.progress = noting(goOn, done);
    stepped = bio::calibrateAtShorterSteps(
        model, choice.systemOptions(), declaring(trials, latent), holdOut, options,
        step ? std::numeric_limits<double>::infinity() : bio::shortestCalibrationStep);
  });
  const bio::Calibration& found = stepped.calibration;
  if (!found.failure.empty()) throw std::runtime_error(found.failure);
  std::optional<bio::CalibratedModel> calibrated;
  if (found.calibrated) {
    calibrated =
        bio::calibratedModel(*stepped.training, stepped.heldOut.get(), choice.systemOptions(),
                             stepped.options.trials.simulation, found);
  }
  py::list minima;
  for (const bio::OtherMinimum& minimum : found.otherMinima) {
    minima.append(results("values"_a = minimum.values, "nats"_a = minimum.difference,
                          "nats_of_data"_a = minimum.ofData));
  }
  py::dict estimates;
  for (const auto& parameter : found.parameters)
    estimates[parameter.asked.name.c_str()] = estimateOf(parameter);
  return tableResult("CalibrationResult", "estimates"_a = estimates,
                     "correlation"_a = found.correlation, "other_minima"_a = minima,
                     "step"_a = stepped.options.trials.simulation.step,
                     "converged"_a = found.converged, "why"_a = info::describe(found.why),
                     "iterations"_a = found.iterations, "noise"_a = found.noise.sd,
                     "effective_noise"_a = found.noise.effective,
                     "rmse_before"_a = rmse(stepped.training.get(), found.before),
                     "rmse_after"_a = calibrated ? calibrated->rms(false) : NAN,
                     "rmse_held_out_before"_a = rmse(stepped.heldOut.get(), found.heldOutBefore),
                     "rmse_held_out"_a = calibrated ? calibrated->rms(true) : NAN,
                     "held_out_predictions"_a = predictionsOf(stepped),
                     "model"_a = calibrated ? py::cast(calibrated->model) : py::none());
}

}  // namespace

void defineCalibration(py::module_& module) {
  defineWithChoice(
      module, "calibrate", &calibrate, docstrings::calibrate, "model"_a, "trials"_a, "parameters"_a,
      py::kw_only(), "hold_out"_a = std::vector<bio::Trial>(), "noise"_a = py::none(),
      "channel_noise"_a = std::map<std::string, double>(), "priors"_a = true, "prior"_a = Pairs(),
      "bounds"_a = Pairs(), "loss"_a = "gaussian", "own_start"_a = false, "latent"_a = Pairs(),
      "initial"_a = std::map<std::string, double>(), "starts"_a = 1, "seed"_a = 1, "threads"_a = 1,
      "profile"_a = std::vector<std::string>(), "bootstrap"_a = 0, "progress"_a = false);
}

}  // namespace python
