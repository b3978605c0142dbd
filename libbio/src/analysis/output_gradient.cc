#include "bio/analysis/output_gradient.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace bio {
OutputGradient gradientOfOutputs(const StudiedTrial& trial, const SensitivityQuestion& question,
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
  OutputGradient found;
  const MotionCost weighted = [&](const Trajectory& motion) {
    found.outputs = observed.values(motion);
    CostOfMotion cost;
    cost.value = weights.dot(found.outputs);
    if (std::isfinite(cost.value)) observed.pullBack(motion, weights, cost.q, cost.qDot);
    return cost;
  };
  found.sum = simulateWithGradient(system, trial.catalogue, setting, question.selection,
                                   trial.recorded.excitation, trial.recorded.simulation, weighted);
  return found;
}

}  // namespace bio
