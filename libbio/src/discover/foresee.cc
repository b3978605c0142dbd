#include "bio/discover/foresee.h"

#include <algorithm>
#include <stdexcept>

#include "bio/discover/planned.h"
#include "info/discover/separation.h"

namespace bio::discover {

using Eigen::Index;

namespace {

/// What the experimenter changes, for each quantity of the planned experiment; empty if one is not
/// there.
Eigen::VectorXd knownChanges(const info::discover::Disagreement& planned,
                             const std::vector<std::pair<std::string, double>>& known) {
  const auto& quantities = planned.quantities();
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(static_cast<Index>(quantities.size()));
  for (const auto& [name, change] : known) {
    const auto at = std::find_if(quantities.begin(), quantities.end(),
                                 [&](const auto& quantity) { return quantity.name == name; });
    if (at == quantities.end()) return {};
    changes[at - quantities.begin()] = change;
  }
  return changes;
}

}  // namespace

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
  for (const auto& experiment : plannedExperiments(trial, coordinate)) {
    const ElbowDisagreement planned(model, arm, coordinate.name, {experiment.trial}, options);
    const Eigen::VectorXd known = knownChanges(planned, experiment.known);
    if (known.size() == 0) continue;
    // where the arm would go
    Eigen::VectorXd values = info::discover::nominalValues(planned);
    const auto own = static_cast<Index>(data.widest().quantities().size());
    values.head(own) = verdict.values.head(own) + known.head(own);
    const Eigen::VectorXd motion = planned.outputs(0, values, {});
    if (!motion.allFinite() || motion.minCoeff() < coordinate.rangeMin ||
        motion.maxCoeff() > coordinate.rangeMax)
      continue;
    ForeseenExperiment one{experiment.sentence, {}};
    try {
      for (std::size_t rival = 1; rival < verdict.rivals.size(); ++rival)
        one.nats.push_back(info::discover::expectedSeparation(
            planned, known, data, verdict.rivals.front(), verdict.rivals[rival]));
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
