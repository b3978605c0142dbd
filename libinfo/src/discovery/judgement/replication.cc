#include "discovery/judgement/replication.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "discovery/verdict_estimates.h"

namespace info::discover {
namespace {

// Amplitudes agree that differ by no more standard deviations than this.
constexpr double kAgree = 2;

bool mayReplicate(const DiscoveryProblem& data, const Effects& effects) {
  return std::none_of(effects.begin(), effects.end(), [&](std::size_t effect) {
    const EffectKind kind = data.candidates()[effect].kind;
    return kind == EffectKind::parameter || kind == EffectKind::geometry;
  });
}

bool agree(const Estimate& estimate, const Estimate& other) {
  return std::abs(estimate.value - other.value) <= kAgree * std::hypot(estimate.sd, other.sd);
}

}  // namespace

std::optional<Replication> replicate(const DiscoveryProblem& data, const Options& options,
                                     const Whitening& sds, const Entry& entry,
                                     const Search::Report& report) {
  if (entry.effects.empty() || !mayReplicate(data, entry.effects)) return {};
  Search search(data, options.heldOut, options, sds, report);
  Effects effects;
  try {
    search.calibrate();
    for (const std::size_t effect : entry.effects) {
      search.race(effects, {effect});
      effects = with(effects, effect);
    }
  } catch (const std::domain_error&) {
    return {};
  }
  search.enforceNesting();
  const Entry& found = search.at(effects);
  if (!found.works()) return {};
  Replication replication;
  replication.logBayesFactor = found.score - search.at({}).score;
  replication.replicated =
      replication.logBayesFactor >= options.evidence * static_cast<double>(effects.size()) &&
      search.significance(found) >= options.significance &&
      found.fit.noise.latent <= options.latentTolerance;
  for (const std::size_t effect : effects) {
    const auto& quantities = data.candidates()[effect].quantities;
    const auto here = estimatesOf(found.fit, quantities, data);
    const auto there = estimatesOf(entry.fit, quantities, data);
    replication.replicated = replication.replicated && agree(here.front(), there.front());
    replication.estimates.insert(replication.estimates.end(), here.begin(), here.end());
  }
  return replication;
}

}  // namespace info::discover
