#include "bio/analysis/output_gradient.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio {
namespace {

/// What predictorOf() observes.
std::vector<ObservedSeries> observedSeries(const StudiedTrial& trial,
                                           const SensitivityQuestion& question) {
  const Eigen::VectorXd times =
      Eigen::VectorXd::Map(trial.times.data(), static_cast<Eigen::Index>(trial.times.size()));
  std::vector<ObservedSeries> series;
  for (const ChannelCandidate& channel : question.observed) series.push_back({channel.what, times});
  if (series.empty()) {
    ObservedSeries& coordinate = series.emplace_back();
    coordinate.what.object = question.coordinate;
    coordinate.times = times;
  }
  return series;
}

}  // namespace

CostGradient gradientOfOutputs(const StudiedTrial& trial, const SensitivityQuestion& question,
                               const Eigen::VectorXd& theta, const Eigen::VectorXd& weights) {
  const ParameterCatalogue::Setting setting = trial.catalogue.at(question.selection, theta);
  const MusculoskeletalSystem system(setting.model, question.system);
  const ObservedMotion observed(system, observedSeries(trial, question));
  observed.requireAdjoint();
  if (weights.size() != observed.size()) {
    throw std::invalid_argument(fmt::format("{}: {} weights for {} outputs, must be as many",
                                            trial.file, weights.size(), observed.size()));
  }
  if (!weights.allFinite()) {
    throw std::invalid_argument(trial.file + ": a weight of an output is not finite");
  }
  const MotionCost weighted = [&](const Trajectory& motion) {
    CostOfMotion cost;
    cost.value = weights.dot(observed.values(motion));
    if (std::isfinite(cost.value)) observed.pullBack(motion, weights, cost.q, cost.qDot);
    return cost;
  };
  return simulateWithGradient(system, trial.catalogue, setting, question.selection,
                              trial.recorded.excitation, trial.recorded.simulation, weighted);
}

}  // namespace bio
