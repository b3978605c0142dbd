#include "discovery/judgement/held_out_trials.h"

#include <algorithm>

namespace info::discover {

std::vector<int> fittedTrials(const DiscoveryProblem& data, const Options& options) {
  std::vector<int> trials;
  for (int t = 0; t < data.numTrials(); ++t)
    if (std::find(options.heldOut.begin(), options.heldOut.end(), t) == options.heldOut.end())
      trials.push_back(t);
  return trials;
}

HeldOutTrials heldOutTrials(const DiscoveryProblem& data, const Search& search, const Entry& entry,
                            const Likelihood& all, const Likelihood& held) {
  HeldOutTrials result;
  // their initial states are not fitted yet: start with a large latent force
  Noise wide = entry.fit.noise, still = entry.fit.noise;
  wide.latent = std::max(wide.latent, 0.1);
  still.latent = 0;
  const Hypothesis hypothesis = makeHypothesis(data, entry.effects, all.trials());
  std::optional<Fit> best;
  const auto together = [&](const Eigen::VectorXd& from) {
    auto fit = all.tryFit(hypothesis, entry.fit.noise, from, {}, {30, 0.05});
    if (fit && (!best || fit->logEvidence > best->logEvidence)) best = std::move(fit);
  };
  if (const auto first = all.tryFit(hypothesis, wide, entry.fit.values, {}, {10, 0.1}))
    together(first->values);
  const Hypothesis starts = startsOnly(data, held.trials());
  if (const auto near = held.tryFit(starts, wide, entry.fit.values, {}, {10, 0.1})) {
    if (auto fit = held.tryFit(starts, still, near->values, {}, {30, 0.01})) {
      result.error = held.simulationError(fit->values, fit->noise.output);
      together(fit->values);  // the other values are final
      result.starts = std::move(fit);
    }
  }
  if (best) {
    if (search.exceedsNoise(*best)) best = all.marginal(*best);
    // log Z of all trials less that of the fitted ones
    result.score = best->logEvidence - entry.fit.logEvidence;
    result.meanSquare = 2 * (best->cost - entry.fit.cost) / static_cast<double>(held.samples());
  }
  return result;
}

}  // namespace info::discover
