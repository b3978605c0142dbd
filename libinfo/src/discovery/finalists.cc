#include "discovery/finalists.h"

#include <algorithm>
#include <cmath>

#include "discovery/verdict_estimates.h"

namespace info::discover {

std::vector<Finalist> finalistsOf(const Search& search) {
  const DiscoveryProblem& data = search.likelihood().data();
  const double ofBase = search.at({}).score;
  std::vector<Finalist> finalists;
  for (const auto& [effects, entry] : search.entries()) {
    if (!entry.works()) continue;
    Finalist f;
    f.effects = effects;
    f.logEvidence = entry.score - ofBase;
    f.latentSize = entry.fit.noise.latent;
    f.significance = search.significance(entry);
    for (const std::size_t e : effects)
      for (const Estimate& x : estimatesOf(entry.fit, data.candidates()[e].quantities, data))
        f.estimates.push_back(x);
    finalists.push_back(f);
  }
  const double rarity =
      std::log(0.5 / std::max(1.0, static_cast<double>(data.candidates().size())));
  const auto posterior = [&](const Finalist& f) {
    return f.logEvidence + rarity * static_cast<double>(f.effects.size());
  };
  std::sort(finalists.begin(), finalists.end(),
            [&](const Finalist& a, const Finalist& b) { return posterior(a) > posterior(b); });
  double sum = 0;
  for (const Finalist& f : finalists) sum += std::exp(posterior(f) - posterior(finalists[0]));
  for (Finalist& f : finalists)
    f.probability = std::exp(posterior(f) - posterior(finalists[0])) / sum;
  return finalists;
}

}  // namespace info::discover
