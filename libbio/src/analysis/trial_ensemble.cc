#include "bio/analysis/trial_ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bio/analysis/ensemble_statistics.h"
#include "bio/analysis/replay.h"
#include "bio/analysis/sensitivity_study.h"
#include "bio/simulation/simulate.h"
#include "info/probability/global_sensitivity.h"
#include "info/probability/random_stream.h"

namespace bio {
namespace {

std::vector<EnsembleChannel> observedChannels(const Trial& trial, const Model& model,
                                              const MusculoskeletalSystem& system,
                                              const TrialEnsembleOptions& asked) {
  std::vector<Observable> observed;
  for (const std::string& name : asked.observe) {
    observed.push_back(observableNamed(name, model));
    if (std::find(observed.begin(), observed.end() - 1, observed.back()) != observed.end() - 1) {
      throw std::invalid_argument(fmt::format("observe: '{}' is given twice", name));
    }
  }
  const std::vector<Coordinate>& coordinates = system.skeleton().coordinates();
  for (std::size_t i = 0; asked.observe.empty() && i < coordinates.size(); ++i) {
    if (system.isPrescribed(static_cast<int>(i))) continue;
    observed.push_back(ofCoordinate(coordinates[i].name));
  }
  if (observed.empty()) {
    throw std::invalid_argument(
        fmt::format("no coordinate is free to be observed: {}observe must name what is",
                    asked.laws.optionPrefix));
  }
  std::vector<EnsembleChannel> channels;
  for (const Observable& what : observed) {
    const MeasuredChannel* measured = trial.measurementOf(what);
    channels.push_back({what, measured ? std::optional(*measured) : std::nullopt});
  }
  return channels;
}

}  // namespace

TrialEnsemble::TrialEnsemble(const Model& model, const MusculoskeletalSystem& system,
                             const SystemOptions& options, const Trial& trial,
                             const StartPoint& start, const TrialEnsembleOptions& asked)
    : catalogue_(model, system, start),
      laws_(parameterLaws(catalogue_, asked.laws)),
      sobol_(asked.sobol),
      draws_(asked.draws) {
  std::vector<EnsembleChannel> channels = observedChannels(trial, model, system, asked);
  check(trial, channels, asked);
  const RecordedTrial recorded = recordedTrial(trial, system, asked.simulation);
  const SimulationOptions& simulation = recorded.simulation;
  batch_ = std::make_unique<const SystemBatch>(
      catalogue_, options, recorded.excitation, std::move(channels),
      bandTimes(simulation.startTime, simulation.duration, asked.bandPoints), laws_.selection,
      simulation);
  const Trajectory motion =
      simulate(system, recorded.excitation, recorded.startAt(system, start), simulation);
  if (const auto left = leftRange(system, motion))
    remark_ = "with the model's own parameters, " + left->what;
}

void TrialEnsemble::check(const Trial& trial, const std::vector<EnsembleChannel>& channels,
                          const TrialEnsembleOptions& asked) const {
  const std::string& prefix = asked.laws.optionPrefix;
  const auto refuse = [](const std::string& why) { throw std::invalid_argument(why); };
  if (asked.draws < 1 || asked.draws > 10000000) {
    refuse(fmt::format("{}draws = {}, must be 1 to 10000000", prefix, asked.draws));
  }
  if (asked.bandPoints < 2 || asked.bandPoints > 1000) {
    refuse(fmt::format("{}band_points = {}, must be 2 to 1000", prefix, asked.bandPoints));
  }
  (void)ensembleOutputNamed(asked.output);
  if (!asked.sobol) return;
  if (laws_.together) refuse(fmt::format("{0}covariance cannot be combined with {0}sobol", prefix));
  if (laws_.selection.size() > mostGlobalParameters) {
    refuse(fmt::format("{0}sobol: {1} parameters, at most {2}; choose them with {0}parameters",
                       prefix, laws_.selection.size(), mostGlobalParameters));
  }
  if (asked.draws < 2) refuse(fmt::format("{0}sobol: {0}draws must be at least 2", prefix));
  for (const EnsembleChannel& channel : channels) {
    if (asked.output != "rms_error" || channel.measured) continue;
    refuse(fmt::format("{}output rms_error: {} has no measured {}", prefix, trial.file,
                       nameOf(channel.what)));
  }
}

std::uint64_t TrialEnsemble::count() const {
  const auto n = static_cast<std::uint64_t>(draws_);
  return sobol_ ? n * (laws_.parameters.size() + 2) : n;
}

Eigen::VectorXd TrialEnsemble::draw(std::uint64_t number, std::uint64_t seed) const {
  const auto p = static_cast<int>(laws_.parameters.size());
  if (sobol_) return laws_.at(info::sobolPoint(number, p, seed));
  info::RandomStream random(seed, number);
  Eigen::VectorXd unit(p);
  for (double& u : unit) u = random.uniform();
  return laws_.at(std::move(unit));
}

}  // namespace bio
