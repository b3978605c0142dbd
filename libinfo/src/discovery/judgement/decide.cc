#include "info/discovery/judgement/decide.h"

#include <algorithm>
#include <cmath>

#include "discovery/search/effect_sets.h"

namespace info::discover {

namespace {

const Finalist* find(const std::vector<Finalist>& raced, const std::vector<std::size_t>& effects) {
  for (const Finalist& f : raced)
    if (f.effects == effects) return &f;
  return nullptr;
}

// the class of one effect, the others being kept
NamedEffect classOf(const std::vector<Candidate>& candidates, const Judgement& judgement,
                    const Finalist& leader, std::size_t effect, const Options& options) {
  NamedEffect named;
  named.candidate = effect;
  const Effects rest = without(leader.effects, effect);
  const Finalist* others = find(judgement.raced, rest);
  named.logBayesFactor = others != nullptr ? leader.logEvidence - others->logEvidence : 0;
  for (const Estimate& e : leader.estimates) {
    const auto& own = candidates[effect].quantities;
    if (std::find(own.begin(), own.end(), e.quantity) != own.end()) named.estimates.push_back(e);
  }
  named.equals = {effect};
  named.equalEvidence = {0};
  double sum = 1 + (others != nullptr
                        ? std::exp(-named.logBayesFactor) * static_cast<double>(candidates.size())
                        : 0);
  const auto& declared = candidates[effect].equivalents;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (std::find(leader.effects.begin(), leader.effects.end(), c) != leader.effects.end())
      continue;
    const Finalist* rival = find(judgement.raced, with(rest, c));
    const bool equal =
        std::find(declared.begin(), declared.end(), candidates[c].id) != declared.end();
    if (rival == nullptr && !equal) continue;
    const double behind = rival != nullptr ? rival->logEvidence - leader.logEvidence : 0;
    // declared equivalents in a class differ in their priors only, not in the fit to the data
    const bool tied = equal && behind > -options.classWidth;
    if (tied || rival != nullptr) sum += tied ? 1 : std::exp(behind);
    if (equal || behind > -options.classWidth) {
      named.equals.push_back(c);
      named.equalEvidence.push_back(behind);
      named.exact = named.exact || equal;
    }
  }
  named.probability = 1 / sum;
  return named;
}

// Whether an effect without alternatives has a shape parameter at a bound.
bool isStretched(const NamedEffect& named, const Candidate& candidate) {
  return named.equals.size() == 1 &&
         std::any_of(named.estimates.begin(), named.estimates.end(), [&](const Estimate& e) {
           return e.atBound && e.quantity != candidate.quantities.front();
         });
}

}  // namespace

Decision decide(const std::vector<Candidate>& candidates, const Judgement& judgement,
                const Options& options) {
  Decision decision;
  const Finalist* leader = find(judgement.raced, judgement.chosen);
  if (judgement.chosen.empty() || leader == nullptr) {
    const bool fits = judgement.before.adequate() && !judgement.strangeBefore &&
                      judgement.latentBefore <= options.latentTolerance;
    decision.finding = !fits                                      ? Finding::unknown
                       : judgement.priorZ > options.largestPriorZ ? Finding::parameter
                                                                  : Finding::none;
    return decision;
  }
  bool alone = true, parameters = true, stretched = false;
  decision.probability = 1;
  for (const std::size_t effect : judgement.chosen) {
    decision.effects.push_back(classOf(candidates, judgement, *leader, effect, options));
    const NamedEffect& named = decision.effects.back();
    alone = alone && named.equals.size() == 1;
    stretched = stretched || isStretched(named, candidates[effect]);
    for (const std::size_t c : named.equals)
      parameters = parameters && candidates[c].kind == EffectKind::parameter;
    decision.probability *= named.probability;
  }
  const Adequacy& after = judgement.after;
  const bool contradicted = judgement.heldOutWorse || judgement.strangeAfter;
  const bool explainsNothing = judgement.explained && *judgement.explained < options.leastExplained;
  const bool denied =
      stretched || explainsNothing || (judgement.heldOutWorse && !judgement.replicated);
  const bool incomplete = !after.white || !after.independent || !after.causeless ||
                          judgement.latentAfter > options.latentTolerance ||
                          judgement.nonparametricWins ||
                          (judgement.strangeAfter && !judgement.replicated);
  const bool carriesOver =
      judgement.heldOutExplained && *judgement.heldOutExplained >= options.carriesOver;
  decision.reserved = incomplete && !denied && carriesOver && !(after.white && after.sized);
  if (denied || (incomplete && !decision.reserved)) {
    decision.finding = Finding::unknown;
    decision.surrogate = true;
    decision.probability = 0;
    for (NamedEffect& effect : decision.effects) effect.probability = std::nan("");
    return decision;
  }
  decision.finding = !alone ? Finding::ambiguous : parameters ? Finding::parameter : Finding::named;
  if (decision.reserved || !after.sized || judgement.heldOutFarOff || judgement.heldOutVague ||
      contradicted) {
    decision.vetoed = true;
    decision.probability = 0;
  }
  return decision;
}

}  // namespace info::discover
