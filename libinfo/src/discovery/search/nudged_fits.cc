#include <algorithm>
#include <cmath>

#include "discovery/search/search.h"
#include "discovery/search/search_tuning.h"
#include "info/estimation/nudge_stages.h"

// Fits with nudging, and the fits of the original model that continue from them.

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// Fits that start with nudging: the stage at which their evidence is compared, by how many nats one
// may be behind the best there, and how many are fitted to convergence.
constexpr std::size_t kHalfWay = 3;
constexpr double kNudgedBehind = 10;
constexpr std::size_t kNudgedFits = 3;
// predicted gain [nats] of one step of a nudged model
constexpr double kExplainsMuch = 20;

}  // namespace

std::optional<VectorXd> Search::nudgedFrom(const Effects& effects, const VectorXd& start) {
  const std::size_t stages = nudgedLikelihoods_.size();
  NudgedFit nudged{start};
  if (stages == 0 || !fitNudged(effects, 0, stages, nudged)) return {};
  return std::move(nudged.values);
}

bool Search::fitNudged(const Effects& effects, std::size_t first, std::size_t end,
                       NudgedFit& nudged) {
  const Hypothesis hypothesis = makeHypothesis(data_, effects, trials_);
  for (std::size_t i = first; i < end; ++i) {
    const Noise noise{output_.scaled(nudgeStages[i].spread), 0, options_.latentTime};
    const auto fit = nudgedLikelihoods_[i].tryFit(hypothesis, noise, nudged.values, {}, {6, 0.1});
    ++fits_;
    if (!fit) return false;
    nudged.values = fit->values;
    nudged.evidence = fit->logEvidence;
  }
  return true;
}

std::optional<Search::Tracked> Search::tracked(const Effects& effects, VectorXd start) {
  if (nudgedLikelihoods_.empty()) return {};
  const Hypothesis hypothesis = makeHypothesis(data_, effects, trials_);
  std::optional<Tracked> last;
  std::vector<VectorXd> eta;
  for (const Likelihood& nudged : nudgedLikelihoods_) {
    auto fit = nudged.tryFit(hypothesis, {output_, kFirstSize, options_.latentTime}, start, eta,
                             {kShort, 0.1});
    ++fits_;
    if (!fit) continue;
    start = fit->values;
    eta = fit->eta;
    last = Tracked{std::move(*fit), &nudged};
  }
  return last;
}

// All candidates are led half way; of the weakest nudging only those need to come through that are
// continued without it.
void Search::raceNudged(const Effects& base, const std::vector<std::size_t>& candidates) {
  const std::size_t stages = nudgedLikelihoods_.size(), half = std::min(kHalfWay + 1, stages);
  if (stages == 0) return;
  std::vector<std::pair<std::size_t, NudgedFit>> all;
  const VectorXd nominal = nominalValues(data_);
  for (const std::size_t c : candidates) {
    const Effects effects = with(base, c);
    if (!raced_.insert(effects).second) continue;
    report_(describe(data_, effects));
    VectorXd start = nominal;
    for (const std::size_t e : base)
      for (const std::size_t q : data_.candidates()[e].quantities)
        start[static_cast<Index>(q)] = at(base).fit.values[static_cast<Index>(q)];
    Fit near = at(base).fit;
    near.values = std::move(start);
    NudgedFit nudged{bestStart(base, c, near, 0)};
    if (fitNudged(effects, 0, half, nudged)) all.emplace_back(c, std::move(nudged));
  }
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return a.second.evidence > b.second.evidence; });
  std::vector<double> nudged;  // evidence half way of those that came through
  for (auto& [c, one] : all) {
    const double evidence = one.evidence;
    if (nudged.size() == kNudgedFits ||
        (!nudged.empty() && evidence < nudged.front() - kNudgedBehind))
      break;
    const Effects effects = with(base, c);
    report_(describe(data_, effects));
    if (!fitNudged(effects, half, stages, one)) continue;
    nudged.push_back(evidence);
    continueNudged(effects, one.values);
  }
}

void Search::continueNudged(const Effects& effects, const VectorXd& start) {
  const Noise still{output_, 0, options_.latentTime};
  const auto fit =
      likelihood_->tryFit(makeHypothesis(data_, effects, trials_), still, start, {}, {kShort, 0.1});
  ++fits_;
  if (!fit) return;
  const Entry& entry = at(effects);
  const bool isKnown = entry.simulation && entry.simulation->logEvidence > fit->logEvidence - kNews;
  if (!isKnown) improve(effects, fit->values, kSmallSize, nullptr, bestScore() - kGivenUp);
}

VectorXd Search::bestStart(const Effects& base, std::size_t candidate, const Fit& near,
                           double latent) {
  const Hypothesis hypothesis = makeHypothesis(data_, with(base, candidate), trials_);
  const Candidate& c = data_.candidates()[candidate];
  const std::size_t starts = isGrid(c) ? 2 : c.starts.size();  // searchGrid covers the whole grid
  if (const auto start = gridStarts_.find(candidate);
      start != gridStarts_.end() && start->second.values.size() > 0) {
    // alone, with the nuisance parameters of that fit
    VectorXd from = latent == 0 && base.empty() ? start->second.values : near.values;
    const auto amplitude = static_cast<Index>(data_.candidates()[candidate].quantities[0]);
    from[amplitude] = start->second.values[amplitude];
    return from;
  }
  const bool held = !nudgedLikelihoods_.empty();
  const Noise noise{held ? output_.scaled(nudgeStages[0].spread) : output_, held ? 0 : latent,
                    options_.latentTime};
  const auto eta = held ? std::vector<VectorXd>() : forceKept(near.eta, near.noise.latent, latent);
  VectorXd from = started(candidate, 0, near.values);
  double evidence = -1e300;
  for (std::size_t s = 0; starts > 1 && s < starts; ++s) {
    const Likelihood& likelihood = held ? nudgedLikelihoods_.front() : *likelihood_;
    const auto fit = likelihood.tryFit(hypothesis, noise, started(candidate, s, near.values), eta,
                                       {held ? 3 : 5, 0.1});
    if (fit && fit->logEvidence > evidence) {
      evidence = fit->logEvidence;
      from = fit->values;
    }
    ++fits_;
  }
  return from;
}

std::vector<Screened> Search::screenHeld(const Effects& effects) {
  if (nudgedLikelihoods_.size() <= kHeldStage) return {};
  const Likelihood& held = nudgedLikelihoods_[kHeldStage];
  const Noise noise{output_.scaled(nudgeStages[kHeldStage].spread), 0, options_.latentTime};
  const auto fitted = [&](const Effects& tried, const VectorXd& from, int iterations) {
    ++fits_;
    return held.tryFit(makeHypothesis(data_, tried, trials_), noise, from, {}, {iterations, 0.1});
  };
  VectorXd start = nominalValues(data_);
  for (const std::size_t e : effects)
    for (const std::size_t q : data_.candidates()[e].quantities)
      start[static_cast<Index>(q)] = at(effects).fit.values[static_cast<Index>(q)];
  const auto fit = fitted(effects, start, 12);
  if (!fit) return {};
  std::vector<Screened> result = screenAt(held, *fit, effects);
  // candidates with a grid of starts have several minima, which a linear step at 0 does not find;
  // they are searched if nothing else explains much
  if (!result.empty() && result.front().gain > kExplainsMuch) return result;
  for (Screened& s : result) {
    const Candidate& c = data_.candidates()[s.candidate];
    if (!isGrid(c) || !effects.empty()) continue;
    if (gridStarts_.count(s.candidate) == 0)
      gridStarts_[s.candidate] = searchGrid(s.candidate, *fit);
    s.gain = std::max(s.gain, gridStarts_[s.candidate].gain);
  }
  std::sort(result.begin(), result.end(),
            [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  return result;
}

}  // namespace info::discover
