#include "bio/discovery/predicted_experiments.h"

#include <algorithm>
#include <stdexcept>

#include "bio/discovery/passive_motion.h"
#include "bio/discovery/planned_experiments.h"
#include "info/discovery/judgement/separation.h"

namespace bio::discover {

using Eigen::Index;

namespace {

/// Whether the coordinates among the outputs stay in their ranges.
bool staysInRange(const MusculoskeletalProblem& planned, const Eigen::VectorXd& outputs) {
  const std::vector<int>& which = planned.outputOfSample(0);
  for (Index k = 0; k < outputs.size(); ++k) {
    const auto sensor = which.empty()
                            ? std::size_t{0}
                            : static_cast<std::size_t>(which[static_cast<std::size_t>(k)]);
    const Observable& what = planned.encompassing().sensors()[sensor];
    for (const MovingCoordinate& at : planned.encompassing().coordinates()) {
      if (what != ofCoordinate(at.coordinate.name)) continue;
      if (outputs[k] < at.coordinate.rangeMin || outputs[k] > at.coordinate.rangeMax) return false;
    }
  }
  return true;
}

}  // namespace

double PredictedExperiment::least() const {
  return nats.empty() ? 0 : *std::min_element(nats.begin(), nats.end());
}

std::vector<PredictedExperiment> predictExperiments(const Trial& trial,
                                                    const MusculoskeletalProblem& data,
                                                    const info::discover::Verdict& verdict) {
  std::vector<PredictedExperiment> predictedExperiments;
  if (verdict.rivals.size() < 2) return predictedExperiments;
  const EncompassingModel& encompassing = data.encompassing();
  std::vector<PlannedExperiment> experiments = plannedExperiments(trial, encompassing);
  for (PlannedExperiment& experiment : passiveMotions(trial, encompassing))
    experiments.push_back(std::move(experiment));
  for (const PlannedExperiment& experiment : experiments) {
    MusculoskeletalProblemOptions options = data.options();
    if (!experiment.keepsStart) options.initial.clear();
    const MusculoskeletalProblem planned(encompassing.base(), encompassing.systemOptions(),
                                         encompassing.coordinateNames(), {experiment.trial},
                                         options);
    // where the system would go
    Eigen::VectorXd values = info::discover::nominalValues(planned);
    const auto own = static_cast<Index>(encompassing.quantities().size());
    values.head(own) = verdict.values.head(own);
    const Eigen::VectorXd motion = planned.outputs(0, values, {});
    if (!motion.allFinite() || !staysInRange(planned, motion)) continue;
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
