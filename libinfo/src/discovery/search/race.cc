#include <algorithm>

#include "discovery/search/search.h"
#include "discovery/search/search_tuning.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

void Search::raceOne(const Effects& base, std::size_t candidate) {
  const auto effects = with(base, candidate);
  if (entries_.count(effects) != 0) return;
  const Fit near = at(base).fit;
  const VectorXd& values = near.values;
  const double raceSize = std::clamp(2 * near.noise.latent, 0.01, kRaceSize);
  report_(describe(data_, effects));
  improve(effects, bestStart(base, candidate, near, raceSize), raceSize, &near,
          bestScore() - kGivenUp);
  if (base.empty() && isGrid(data_.candidates()[candidate]) && exceedsNoise(near))
    if (const auto fit = searchForcedGrid(candidate))
      improve(effects, fit->values, fit->noise.latent, &*fit, bestScore() - kGivenUp);
  // a hypothesis that contains the base cannot be much worse: a wrong minimum; repeat from the base
  // itself
  if (at(effects).score < at(base).score - options_.evidence)
    improve(effects, absent(candidate, values), near.noise.latent, &near);
}

void Search::race(const Effects& base, const std::vector<std::size_t>& candidates) {
  const std::size_t known = entries_.size();
  for (const std::size_t c : candidates) raceOne(base, c);
  raceNudged(base, candidates);
  const bool news = entries_.size() > known;
  if (!news) return;
  // cross-starts: all hypotheses that are not far behind, and the next three in any case, are
  // repeated from the leader's nuisance parameters
  const auto lead = [&] {
    std::size_t leader = candidates[0];
    for (const std::size_t c : candidates)
      if (at(with(base, c)).score > at(with(base, leader)).score) leader = c;
    return leader;
  };
  const std::size_t leader = lead();
  const Entry& first = at(with(base, leader));
  if (!first.works()) return;
  const VectorXd from = first.fit.values;
  const double score = first.score;
  const double size = std::max(2e-3, first.fit.noise.latent);
  std::vector<double> scores;
  for (const std::size_t c : candidates) scores.push_back(at(with(base, c)).score);
  std::sort(scores.rbegin(), scores.rend());
  const double hopeful = std::min(score - 25, scores[std::min<std::size_t>(3, scores.size() - 1)]);
  for (const std::size_t c : candidates) {
    if (c == leader || at(with(base, c)).score < hopeful) continue;
    report_(describe(data_, with(base, c)));
    VectorXd start = absent(leader, from);
    const Entry& own = at(with(base, c));
    for (const std::size_t i : ownQuantities(c)) {
      const auto q = static_cast<Index>(data_.candidates()[c].quantities[i]);
      start[q] = own.fit.values[q];
    }
    improve(with(base, c), start, size, &first.fit, bestScore() - kGivenUp);
  }
  report_(describe(data_, base));
  improve(base, absent(leader, from), size, &first.fit);
}

void Search::raceFromNominal(std::size_t most) {
  racedFromNominal_ = true;
  if (const auto held = screenHeld({}); !held.empty()) {
    std::vector<std::size_t> best;
    for (const Screened& s : held)
      if (best.size() < 2 * most && s.information > 0) best.push_back(s.candidate);
    race({}, best);
    return;
  }
  struct Start {
    std::size_t candidate;
    Hypothesis hypothesis;
    Fit fit;
  };
  std::vector<Start> starts;
  const VectorXd nominal = nominalValues(data_);
  const Noise wide{output_, kFirstSize, options_.latentTime};
  const auto bestFirst = [&] {
    std::sort(starts.begin(), starts.end(),
              [](const Start& a, const Start& b) { return a.fit.logEvidence > b.fit.logEvidence; });
  };
  for (std::size_t c = 0; c < data_.candidates().size(); ++c) {
    report_(describe(data_, {c}));
    const Hypothesis hypothesis = makeHypothesis(data_, {c}, trials_);
    for (std::size_t s = 0; s < data_.candidates()[c].starts.size(); ++s) {
      auto fit = likelihood_->tryFit(hypothesis, wide, started(c, s, nominal), {}, {3, 0.1});
      ++fits_;
      if (fit) starts.push_back({c, hypothesis, std::move(*fit)});
    }
  }
  bestFirst();  // the better half is continued
  starts.erase(starts.begin() + static_cast<std::ptrdiff_t>((starts.size() + 1) / 2), starts.end());
  for (Start& start : starts) {
    report_(describe(data_, {start.candidate}));
    auto fit =
        likelihood_->tryFit(start.hypothesis, wide, start.fit.values, start.fit.eta, {3, 0.1});
    ++fits_;
    if (fit) start.fit = std::move(*fit);
  }
  bestFirst();
  std::vector<std::size_t> taken;
  for (const Start& start : starts) {
    if (taken.size() >= most) break;
    if (std::find(taken.begin(), taken.end(), start.candidate) != taken.end()) continue;
    taken.push_back(start.candidate);
    report_(describe(data_, {start.candidate}));
    improve({start.candidate}, start.fit.values, kFirstSize, &start.fit);
  }
}

}  // namespace info::discover
