#include "bio/analysis/sensitivity_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bio/analysis/replay.h"

namespace bio {
namespace {

/// All of them at these times [s].
std::vector<ObservedSeries> seriesOf(const std::vector<ChannelCandidate>& channels,
                                     const std::vector<double>& times) {
  const auto n = static_cast<Eigen::Index>(times.size());
  std::vector<ObservedSeries> series;
  for (const ChannelCandidate& candidate : channels) {
    series.push_back({candidate.what, Eigen::VectorXd::Map(times.data(), n)});
  }
  return series;
}

/// Γ with the rows of each channel over its noise; of the coordinate as it is.
Eigen::MatrixXd inNoise(const std::vector<ChannelCandidate>& channels, Eigen::MatrixXd gamma) {
  if (channels.empty()) return gamma;
  const auto n = gamma.rows() / static_cast<Eigen::Index>(channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    gamma.middleRows(static_cast<Eigen::Index>(i) * n, n) /= channels[i].sd;
  }
  return gamma;
}

void requireTrials(const std::vector<StudiedTrial>& trials) {
  if (trials.empty()) throw std::invalid_argument("trials: empty, must have at least one");
}

}  // namespace

StudiedTrial studiedTrial(const Trial& trial, const Model& model,
                          const MusculoskeletalSystem& system, const StartPoint& start,
                          SimulationOptions simulation) {
  std::vector<double> times =
      observedTimes(trial, system.skeleton().coordinates().front().name, simulation.step);
  return {trial.file, ParameterCatalogue(model, system, start),
          recordedTrial(trial, system, std::move(simulation)), std::move(times)};
}

std::vector<ChannelCandidate> observedChannels(
    const std::vector<std::pair<std::string, double>>& named, const Model& model,
    const MusculoskeletalSystem& system) {
  std::vector<ChannelCandidate> channels;
  for (const auto& [name, sd] : named) {
    ChannelCandidate channel{observableNamed(name, model), sd};
    if (!(sd > 0 && std::isfinite(sd))) {
      throw std::invalid_argument(
          fmt::format("observe: noise of '{}' = {}, must be > 0 and finite", name, sd));
    }
    channels.push_back(std::move(channel));
  }
  (void)ObservedMotion(system, seriesOf(channels, {}));  // throws for what cannot be observed
  return channels;
}

std::vector<ObservedSeries> observedSeries(const StudiedTrial& trial,
                                           const SensitivityQuestion& question) {
  if (!question.observed.empty()) return seriesOf(question.observed, trial.times);
  return seriesOf({{{Observable::Kind::coordinate, question.coordinate, 0}, question.noise}},
                  trial.times);
}

TrialPredictor predictorOf(const StudiedTrial& trial, const SensitivityQuestion& question) {
  if (question.observed.empty()) {
    return {trial.catalogue, question.system,    trial.recorded.excitation, question.coordinate,
            trial.times,     question.selection, trial.recorded.simulation};
  }
  return {trial.catalogue,           question.system,
          trial.recorded.excitation, observedSeries(trial, question),
          question.selection,        trial.recorded.simulation};
}

std::vector<TrialPredictor> predictorsOf(const std::vector<StudiedTrial>& trials,
                                         const SensitivityQuestion& question) {
  std::vector<TrialPredictor> all;
  for (const StudiedTrial& trial : trials) all.push_back(predictorOf(trial, question));
  return all;
}

LocalSensitivity localSensitivity(const std::vector<StudiedTrial>& trials,
                                  const SensitivityQuestion& question,
                                  const std::function<void(double)>& progress) {
  requireTrials(trials);
  LocalSensitivity found;
  std::vector<Eigen::MatrixXd> gammas;
  for (const StudiedTrial& trial : trials) {
    found.trials.push_back(
        predictorOf(trial, question).withSensitivities(trial.catalogue.values(question.selection)));
    if (!found.trials.back().outputs.allFinite()) {
      throw std::invalid_argument(
          fmt::format("{}: the simulation does not reach the end of the trial", trial.file));
    }
    gammas.push_back(inNoise(question.observed, found.trials.back().gamma));
    if (progress) {
      progress(static_cast<double>(gammas.size()) / static_cast<double>(trials.size()));
    }
  }
  found.information = informationAbout(trials.front().catalogue, question.selection, gammas,
                                       question.observed.empty() ? question.noise : 1);
  return found;
}

std::vector<ChannelCandidate> furtherChannels(const MusculoskeletalSystem& system,
                                              const SensitivityQuestion& question) {
  std::vector<Observable> seen;
  for (const ChannelCandidate& candidate : question.observed) seen.push_back(candidate.what);
  if (question.observed.empty()) {
    seen.push_back({Observable::Kind::coordinate, question.coordinate, 0});
  }
  std::vector<ChannelCandidate> candidates = usualChannels(system);
  std::erase_if(candidates, [&](const ChannelCandidate& candidate) {
    return std::find(seen.begin(), seen.end(), candidate.what) != seen.end();
  });
  return candidates;
}

std::vector<ChannelGain> furtherGains(const std::vector<StudiedTrial>& trials,
                                      const MusculoskeletalSystem& system,
                                      const SensitivityQuestion& question,
                                      const ParameterInformation& before) {
  requireTrials(trials);
  const std::vector<ChannelCandidate> candidates = furtherChannels(system, question);
  std::vector<Eigen::MatrixXd> information;
  for (const StudiedTrial& trial : trials) {
    const auto motion = simulateWithSensitivities(
        system, trial.catalogue, trial.catalogue.nominal(), question.selection,
        trial.recorded.excitation, {trial.recorded.simulation, true, true});
    const auto more = informationOf(system, candidates, trial.times, motion);
    for (std::size_t c = 0; c < more.size(); ++c) {
      if (information.size() == c) {
        information.push_back(more[c]);
      } else {
        information[c] += more[c];
      }
    }
  }
  return channelGains(before, candidates, information);
}

bool gainsTakeLong(std::size_t parameters, std::size_t channels) {
  const double work = std::pow(static_cast<double>(parameters), 3) * static_cast<double>(channels);
  return work > 2e9;  // 285 parameters and 25 channels, 5.8e8, take 0.3 s
}

void requireWithinBounds(const ModelParameter& parameter, const std::vector<double>& values) {
  for (const double value : values) {
    if (value >= parameter.lower && value <= parameter.upper) continue;
    throw std::invalid_argument(fmt::format("values: {} = {} {}, must be {:.4g} to {:.4g} {}{}{}",
                                            parameter.name, value, parameter.unit, parameter.lower,
                                            parameter.upper, parameter.unit,
                                            value >= parameter.limit ? ": " : "",
                                            value >= parameter.limit ? parameter.whyLimited : ""));
  }
}

Sweep parameterSweep(const StudiedTrial& trial, const SystemOptions& options, std::size_t index,
                     const std::vector<double>& values,
                     const std::function<void(double)>& progress) {
  const ModelParameter& parameter = trial.catalogue.parameters()[index];
  requireWithinBounds(parameter, values);
  const auto simulated = [&](double value) {
    const auto setting = trial.catalogue.at({index}, Eigen::VectorXd::Constant(1, value));
    const MusculoskeletalSystem system(setting.model, options);
    return simulateSetting(system, setting, trial.recorded.excitation, trial.recorded.simulation);
  };
  Sweep result{parameter, simulated(parameter.value), {}};
  for (const double value : values) {
    if (progress) {
      progress(static_cast<double>(result.runs.size()) / static_cast<double>(values.size()));
    }
    SweepRun run{value, simulated(value), 0, 0};
    const Eigen::Index rows = std::min(run.motion.q.cols(), result.nominal.q.cols());
    const Eigen::RowVectorXd change =
        run.motion.q.row(0).head(rows) - result.nominal.q.row(0).head(rows);
    run.rms = std::sqrt(change.squaredNorm() / static_cast<double>(rows));
    run.largest = change.cwiseAbs().maxCoeff();
    result.runs.push_back(std::move(run));
  }
  return result;
}

}  // namespace bio
