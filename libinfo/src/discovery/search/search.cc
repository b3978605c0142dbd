#include "discovery/search/search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "discovery/search/search_tuning.h"
#include "info/estimation/nudge_stages.h"
#include "info/probability/random_stream.h"

namespace info::discover {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<VectorXd> forceKept(std::vector<VectorXd> eta, double from, double to) {
  for (VectorXd& one : eta) one *= from / to;
  return eta;
}

Search::Search(const DiscoveryProblem& data, std::vector<int> trials, const Options& options,
               const Whitening& sds, Report report)
    : data_(data),
      trials_(std::move(trials)),
      options_(options),
      output_(sds),
      report_(std::move(report)) {
  likelihood_.emplace(data_, trials_, nominalValues(data_), options_.latentTime);
  for (const NudgeStage& stage : nudgeStages) {
    auto held = data_.nudged(stage.frequency);
    if (!held) break;
    nudged_.push_back(std::move(held));
    nudgedLikelihoods_.emplace_back(*nudged_.back(), trials_, nominalValues(data_),
                                    options_.latentTime);
  }
}

// Maximises the evidence over σ_d, starting from `size`: MacKay's fixed point
//     σ_d² ← σ_d²·|η|²/(γ + σ_d/s)
// then compares with σ_d = 0. The result is kept if it is better than the previous one for the
// hypothesis.
void Search::improve(const Effects& effects, const VectorXd& start, double size, const Fit* near,
                     double hopeless) {
  const Hypothesis hypothesis = makeHypothesis(data_, effects, trials_);
  Entry found;
  found.effects = effects;
  found.score = kFailed;
  const auto keep = [&](Fit fit) {
    ++fits_;
    const double score = scoreOf(fit);
    if (score > found.score) {
      found.score = score;
      found.fit = std::move(fit);
    }
  };
  const auto fitted = [&](double latent, const VectorXd& from, const std::vector<VectorXd>& forces,
                          const FitOptions& options) {
    return likelihood_->tryFit(hypothesis, {output_, latent, options_.latentTime}, from, forces,
                               options);
  };
  VectorXd values = start;
  std::vector<VectorXd> eta;
  if (near != nullptr) eta = forceKept(near->eta, near->noise.latent, size);
  for (int round = 0; round < 6 && size > kSmallest; ++round) {
    std::optional<Fit> tried = fitted(size, values, eta, {kShort, 0.05});
    if (!tried) break;
    if (!tried->converged) {
      if (tried->logEvidence < hopeless) {
        keep(std::move(*tried));
        break;
      }
      if (auto further = fitted(size, tried->values, tried->eta, {kIterations - kShort, 0.05}))
        tried = std::move(further);
    }
    Fit& fit = *tried;
    const double ratio = fit.latentNormSquared /
                         std::max(1e-9, fit.effectiveParameters + size / options_.latentScale);
    const double factor = std::clamp(std::pow(ratio, 0.6), 0.15, 3.0);
    values = fit.values;
    eta = fit.eta;
    keep(std::move(fit));
    if (std::abs(std::log(factor)) < 0.15) break;
    eta = forceKept(std::move(eta), size, factor * size);
    size *= factor;
    if (size > 3) break;
  }
  if (found.score == kFailed || (size < kHopeless && found.score > hopeless)) {
    std::optional<Fit> simulation = fitted(0, values, {}, {kShort, 0.02});
    if (simulation && !simulation->converged && simulation->logEvidence > hopeless)
      if (auto further = fitted(0, simulation->values, {}, {kIterations, 0.02}))
        simulation = std::move(further);
    if (simulation) {
      found.simulation = *simulation;
      keep(std::move(*simulation));
    }
  }
  found.jointScore = found.score;
  const auto former = entries_.find(effects);
  const bool news =
      former == entries_.end() || found.jointScore > former->second.jointScore + kNews;
  if (news && found.works() && exceedsNoise(found.fit) &&
      found.score > bestScore() - kMarginalGain) {
    found.fit = likelihood_->marginal(found.fit);
    found.score = scoreOf(found.fit);
  }
  if (former == entries_.end()) {
    entries_.emplace(effects, std::move(found));
    return;
  }
  Entry& old = former->second;
  if (found.simulation &&
      (!old.simulation || found.simulation->logEvidence > old.simulation->logEvidence))
    old.simulation = std::move(found.simulation);
  if (found.score > old.score) {
    old.score = found.score;
    old.jointScore = found.jointScore;
    old.fit = std::move(found.fit);
  }
}

double Search::scoreOf(const Fit& fit) const {
  return fit.logEvidence - fit.noise.latent / options_.latentScale;
}

// A stop leaves the former likelihood, of which the entries are.
void Search::scaleAt(const VectorXd& values) {
  Likelihood scaled(data_, trials_, values, options_.latentTime);
  likelihood_.emplace(std::move(scaled));
  scaleValues_ = values;
}

void Search::calibrate() {
  report_("base model");
  improve({}, nominalValues(data_), kFirstSize);
  // a base model that needs a large latent force may have moved far from the nominal parameters
  for (const double size : {kWidest, kRaceSize})
    if (!at({}).works() || at({}).fit.noise.latent > kFirstSize)
      improve({}, nominalValues(data_), size);
  if (const auto nudged = tracked({}, nominalValues(data_)))
    improve({}, nudged->fit.values, kFirstSize, &nudged->fit);
  mustWork();
  // evaluate the scale of the latent force along the measured motion, then repeat from both ends
  const Fit first = at({}).fit;
  scaleAt(first.values);
  entries_.clear();
  report_("base model");
  improve({}, first.values, kRaceSize);
  // without its latent force it may not follow the data, or not past a jump
  if (first.noise.latent > 0) improve({}, first.values, first.noise.latent, &first);
  mustWork();
  const std::uint64_t starts = nudgedLikelihoods_.empty() ? kStarts : kStartsBesidesLed;
  for (std::uint64_t start = 0; start < starts; ++start) {
    report_("base model");
    improve({}, drawn(start), kSmallSize, nullptr, bestScore() - kGivenUp);
  }
  report_("base model");
  if (const auto nudged = nudgedFrom({}, nominalValues(data_)))
    improve({}, *nudged, kSmallSize, nullptr, bestScore() - kGivenUp);
}

// The nominal values, followed by samples of the prior.
VectorXd Search::drawn(std::uint64_t start) const {
  VectorXd values = nominalValues(data_);
  if (start == 0) return values;
  RandomStream random(1, start);
  for (const FreeQuantity& q : makeHypothesis(data_, {}, trials_).free)
    if (data_.quantities()[q.quantity].trial < 0)
      values[static_cast<Index>(q.quantity)] =
          q.value(std::clamp(kSpread * random.normal(), q.lowest, q.highest));
  return values;
}

void Search::adopt(const SearchMemory& memory) {
  racedFromNominal_ = memory.racedFromNominal;
  scaleAt(memory.scaleValues);
  const auto again = [&](const Entry& entry) {
    report_(describe(data_, entry.effects));
    improve(entry.effects, entry.fit.values, entry.fit.noise.latent, &entry.fit);
  };
  const Entry& base = memory.entries.at({});
  again(base);
  mustWork();
  const double shift = at({}).score - base.score;
  const Entry& chosen = memory.entries.at(memory.chosen);
  const auto net = [&](const Entry& entry) {
    return entry.score - options_.evidence * static_cast<double>(entry.effects.size());
  };
  for (const auto& [effects, entry] : memory.entries) {
    if (effects.empty()) continue;
    const bool part =
        std::includes(memory.chosen.begin(), memory.chosen.end(), effects.begin(), effects.end());
    const bool rival = effects.size() == memory.chosen.size() &&
                       entry.score > chosen.score - options_.classWidth - kDraftError;
    if (entry.works() && (part || rival || net(entry) > net(chosen) - kDraftError)) {
      again(entry);
    } else {
      Entry kept = entry;
      if (kept.works()) kept.score += shift;
      entries_.emplace(effects, std::move(kept));
    }
  }
}

void Search::take(const SearchMemory& former) {
  scaleAt(former.scaleValues);
  entries_ = former.entries;
  racedFromNominal_ = former.racedFromNominal;
}

void Search::mustWork() const {
  if (!at({}).works())
    throw std::domain_error(
        "the model cannot be simulated over these trials, not even with an added latent force");
}

std::vector<std::size_t> Search::ownQuantities(std::size_t candidate) const {
  const auto& quantities = data_.candidates()[candidate].quantities;
  const auto& nuisances = data_.nuisances();
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (std::find(nuisances.begin(), nuisances.end(), quantities[i]) == nuisances.end())
      own.push_back(i);
  return own;
}

VectorXd Search::started(std::size_t candidate, std::size_t start, VectorXd values) const {
  const Candidate& c = data_.candidates()[candidate];
  for (const std::size_t i : ownQuantities(candidate))
    values[static_cast<Index>(c.quantities[i])] = c.starts.at(start)[static_cast<Index>(i)];
  return values;
}

VectorXd Search::absent(std::size_t candidate, VectorXd values) const {
  const Candidate& c = data_.candidates()[candidate];
  for (const std::size_t i : ownQuantities(candidate))
    values[static_cast<Index>(c.quantities[i])] = data_.quantities()[c.quantities[i]].nominal;
  return values;
}

const Fit& Search::simulation(const Effects& effects) {
  Entry& entry = entries_.at(effects);
  if (!entry.simulation) {
    const Hypothesis hypothesis = makeHypothesis(data_, effects, trials_);
    const Noise still{output_, 0, options_.latentTime};
    entry.simulation = likelihood_->tryFit(hypothesis, still, entry.fit.values, {}, {25, 0.02});
    if (!entry.simulation) {  // it follows the data only because of its latent force
      const VectorXd nominal = nominalValues(data_);
      VectorXd values = nominal;
      for (const std::size_t e : effects)
        for (const std::size_t i : ownQuantities(e)) {
          const auto q = static_cast<Index>(data_.candidates()[e].quantities[i]);
          values[q] = entry.fit.values[q];
        }
      entry.simulation = likelihood_->tryFit(hypothesis, still, values, {}, {25, 0.02});
      // nor may the nominal model be simulable with effects that were fitted beside other
      // parameters
      if (!entry.simulation)
        entry.simulation = likelihood_->tryFit(hypothesis, still, nominal, {}, {25, 0.02});
      // then what is known with the latent force has to do: a search never ends for this
      if (!entry.simulation) entry.simulation = entry.fit;
    }
    ++fits_;
  }
  return *entry.simulation;
}

bool Search::refitBase(const Effects& base) {
  const double before = at(base).score;
  std::vector<std::pair<double, std::size_t>> better;
  for (std::size_t c = 0; c < data_.candidates().size(); ++c) {
    if (std::find(base.begin(), base.end(), c) != base.end()) continue;
    const auto former = entries_.find(with(base, c));
    if (former == entries_.end() || !(former->second.score > before + options_.evidence)) continue;
    if (significance(former->second, c) < 2) better.emplace_back(former->second.score, c);
  }
  if (better.empty()) return false;
  const std::size_t best = std::max_element(better.begin(), better.end())->second;
  drop(with(base, best), best);
  const double after = at(base).score;
  if (!(after > before + options_.evidence)) return false;
  std::erase_if(entries_, [&](const auto& former) {
    const auto& [effects, entry] = former;
    return effects.size() > base.size() && entry.score < after &&
           std::includes(effects.begin(), effects.end(), base.begin(), base.end());
  });
  return true;
}

void Search::drop(const Effects& effects, std::size_t effect) {
  const Entry& entry = at(effects);
  if (!entry.works()) return;
  const Effects rest = without(effects, effect);
  report_(describe(data_, rest));
  improve(rest, absent(effect, entry.fit.values),
          std::clamp(2 * entry.fit.noise.latent, 0.01, kRaceSize), &entry.fit);
}

double Search::bestScore() const {
  double best = kFailed;
  for (const auto& [effects, entry] : entries_) best = std::max(best, entry.score);
  return best;
}

bool Search::complete(double within) {
  const double best = bestScore();
  std::vector<Effects> unfinished;
  for (const auto& [effects, entry] : entries_)
    if (entry.works() && !entry.fit.converged && entry.score > best - within)
      unfinished.push_back(effects);
  bool gained = false;
  for (const Effects& effects : unfinished) {
    const Entry before = at(effects);
    report_(describe(data_, effects));
    improve(effects, before.fit.values, std::max(2e-3, before.fit.noise.latent), &before.fit);
    gained = gained || at(effects).score > before.score + 1;
  }
  return gained;
}

void Search::refineEvidence(const Effects& effects, double within) {
  const double score = at(effects).score;
  for (auto& [others, entry] : entries_) {
    if (!entry.works() || entry.score < score - within || !exceedsNoise(entry.fit)) continue;
    report_(describe(data_, others));
    entry.fit = likelihood_->marginal(entry.fit);
    entry.score = scoreOf(entry.fit);
  }
}

bool Entry::works() const {
  return score > kFailed;
}

void Search::enforceNesting() {
  std::map<Effects, double> asked;  // score of the larger one at its last test
  for (bool again = true; again;) {
    again = false;
    const double best = bestScore();
    for (const auto& [effects, entry] : entries_) {
      if (!entry.works()) continue;
      for (const std::size_t effect : effects) {
        const Effects rest = without(effects, effect);
        const auto former = entries_.find(rest);
        // one that was never fitted is fitted if it would be among the best
        const bool gains = former != entries_.end() ? entry.score > former->second.score + 1
                                                    : entry.score > best - 2 * options_.evidence;
        if (!gains || significance(entry, effect) > 2) continue;
        const auto before = asked.find(rest);
        if (before != asked.end() && entry.score < before->second + 1) continue;
        asked[rest] = entry.score;
        drop(effects, effect);
        again = true;
      }
    }
  }
}

}  // namespace info::discover
