#include "foresee.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "bio/discover/planned.h"
#include "info/discover/separation.h"
#include "text.h"

namespace app {

using Eigen::Index;

namespace {

constexpr double kTells = 5;  // nats

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

std::vector<ForeseenExperiment> foresee(const bio::Model& model, const bio::ArmOptions& arm,
                                        const bio::Trial& trial,
                                        const bio::discover::ElbowOptions& options,
                                        const bio::discover::ElbowDisagreement& data,
                                        const info::discover::Verdict& verdict) {
  std::vector<ForeseenExperiment> foreseen;
  if (verdict.rivals.size() < 2) return foreseen;
  const bio::Coordinate& coordinate = data.widest().coordinate();
  for (const auto& experiment : bio::discover::plannedExperiments(trial, coordinate)) {
    const bio::discover::ElbowDisagreement planned(model, arm, coordinate.name, {experiment.trial},
                                                   options);
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

std::string rivalName(const info::discover::Disagreement& data,
                      const info::discover::Verdict& verdict, std::size_t rival) {
  const auto& first = verdict.rivals.front().hypothesis.effects;
  std::string name;
  for (const std::size_t effect : verdict.rivals[rival].hypothesis.effects) {
    const bool common = std::find(first.begin(), first.end(), effect) != first.end();
    if (rival != 0 && common) continue;
    name += (name.empty() ? "" : " + ") + data.candidates()[effect].id;
  }
  return name;
}

std::string foreseenSentence(const std::vector<ForeseenExperiment>& foreseen,
                             const info::discover::Disagreement& data,
                             const info::discover::Verdict& verdict) {
  if (foreseen.empty() || foreseen.front().least() < kTells) return {};
  const ForeseenExperiment& best = foreseen.front();
  std::string rivals;
  for (std::size_t i = 0; i < best.nats.size(); ++i)
    rivals += fmt::format("{}{} ({} nats)", i == 0 ? "" : ", ", rivalName(data, verdict, i + 1),
                          numberText(best.nats[i], 2));
  std::string what = best.sentence;
  what.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(what.front())));
  return fmt::format(
      "{}. Simulated with all that cannot be told apart, it is expected to tell {} "
      "from {}; {} nats are enough.",
      what, rivalName(data, verdict, 0), rivals, kTells);
}

}  // namespace app
