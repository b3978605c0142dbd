#include "bio/discovery/predicted_experiments.h"

#include <algorithm>
#include <stdexcept>

#include "bio/discovery/passive_motion.h"
#include "bio/discovery/planned_experiments.h"
#include "info/discovery/judgement/separation.h"

namespace bio::discover {

using Eigen::Index;

double PredictedExperiment::least() const {
  return nats.empty() ? 0 : *std::min_element(nats.begin(), nats.end());
}

std::vector<PredictedExperiment> predictExperiments(const Model& model, const SystemOptions& arm,
                                                    const Trial& trial,
                                                    const MusculoskeletalProblemOptions& options,
                                                    const MusculoskeletalProblem& data,
                                                    const info::discover::Verdict& verdict) {
  std::vector<PredictedExperiment> predictedExperiments;
  if (verdict.rivals.size() < 2) return predictedExperiments;
  const Coordinate& coordinate = data.encompassing().coordinate();
  std::vector<PlannedExperiment> experiments = plannedExperiments(trial, data.encompassing());
  for (PlannedExperiment& one : passiveMotions(trial, data.encompassing()))
    experiments.push_back(std::move(one));
  for (const PlannedExperiment& experiment : experiments) {
    const MusculoskeletalProblem planned(model, arm, coordinate.name, {experiment.trial}, options);
    // where the arm would go
    Eigen::VectorXd values = info::discover::nominalValues(planned);
    const auto own = static_cast<Index>(data.encompassing().quantities().size());
    values.head(own) = verdict.values.head(own);
    const Eigen::VectorXd motion = planned.outputs(0, values, {});
    if (!motion.allFinite() || motion.minCoeff() < coordinate.rangeMin ||
        motion.maxCoeff() > coordinate.rangeMax)
      continue;
    PredictedExperiment one{experiment.sentence, {}};
    try {
      for (std::size_t rival = 1; rival < verdict.rivals.size(); ++rival)
        one.nats.push_back(info::discover::expectedSeparation(planned, data, verdict.rivals.front(),
                                                              verdict.rivals[rival]));
    } catch (const std::domain_error&) {
      continue;
    }
    predictedExperiments.push_back(std::move(one));
  }
  std::stable_sort(predictedExperiments.begin(), predictedExperiments.end(),
                   [](const auto& a, const auto& b) { return a.least() > b.least(); });
  return predictedExperiments;
}

}  // namespace bio::discover
