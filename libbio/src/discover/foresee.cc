#include "bio/discover/foresee.h"

#include <algorithm>
#include <stdexcept>

#include "bio/discover/passive_motion.h"
#include "bio/discover/planned.h"
#include "info/discover/separation.h"

namespace bio::discover {

using Eigen::Index;

double ForeseenExperiment::least() const {
  return nats.empty() ? 0 : *std::min_element(nats.begin(), nats.end());
}

std::vector<ForeseenExperiment> foresee(const Model& model, const ArmOptions& arm,
                                        const Trial& trial, const ElbowOptions& options,
                                        const ElbowDisagreement& data,
                                        const info::discover::Verdict& verdict) {
  std::vector<ForeseenExperiment> foreseen;
  if (verdict.rivals.size() < 2) return foreseen;
  const Coordinate& coordinate = data.widest().coordinate();
  std::vector<PlannedExperiment> experiments = plannedExperiments(trial, coordinate);
  for (PlannedExperiment& one : passiveMotions(trial, data.widest()))
    experiments.push_back(std::move(one));
  for (const PlannedExperiment& experiment : experiments) {
    const ElbowDisagreement planned(model, arm, coordinate.name, {experiment.trial}, options);
    // where the arm would go
    Eigen::VectorXd values = info::discover::nominalValues(planned);
    const auto own = static_cast<Index>(data.widest().quantities().size());
    values.head(own) = verdict.values.head(own);
    const Eigen::VectorXd motion = planned.outputs(0, values, {});
    if (!motion.allFinite() || motion.minCoeff() < coordinate.rangeMin ||
        motion.maxCoeff() > coordinate.rangeMax)
      continue;
    ForeseenExperiment one{experiment.sentence, {}};
    try {
      for (std::size_t rival = 1; rival < verdict.rivals.size(); ++rival)
        one.nats.push_back(info::discover::expectedSeparation(planned, data, verdict.rivals.front(),
                                                              verdict.rivals[rival]));
    } catch (const std::domain_error&) {
      continue;
    }
    foreseen.push_back(std::move(one));
  }
  std::stable_sort(foreseen.begin(), foreseen.end(),
                   [](const auto& a, const auto& b) { return a.least() > b.least(); });
  return foreseen;
}

}  // namespace bio::discover
