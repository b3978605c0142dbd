#include "discovery/search/select.h"

#include <algorithm>
#include <optional>

namespace info::discover {
namespace {

constexpr std::size_t kFromNominal = 4;  // single effects that are fitted once more
// Number of alternatives that are fitted in the place of each of several effects. It is large
// because linear predictions may rank the true one low.
constexpr int kRivals = 7;
// More single effects that are fitted if nothing was found although, without the latent force, a
// linear step of theirs promises evidence.
constexpr std::size_t kMore = 8;
constexpr double kAlmost = 0.5;  // share of the evidence that a further effect almost has
// Alternatives of each of two effects that are tried together; one more where no further effect may
// be added, since then nothing else tries the true one: two wrong effects may imitate two right
// ones, one of which is only the third alternative (validation/discovery, the heavy slide).
constexpr std::size_t kPartners = 2;

class Selection {
 public:
  Selection(Search& search, const Options& options) : search_(search), options_(options) {}

  Effects run() {
    for (int round = 0; round < 2 * options_.maxEffects; ++round) {
      const bool first = chosen_.empty();
      if (static_cast<int>(chosen_.size()) >= options_.maxEffects) break;
      if (!first && !promising()) {
        if (onlyParameter() && simplify()) continue;
        break;
      }
      if (!first && simplify()) continue;
      std::vector<std::size_t> list;
      // a base model that is fitted anew forgets those that contain it
      for (int attempt = 1;; ++attempt) {
        list = search_.shortlist(chosen_, first ? options_.finalists : 5);
        search_.race(chosen_, list);
        if (attempt == 3 || !search_.refitBase(chosen_)) break;
      }
      search_.enforceNesting();
      const Effects before = chosen_;
      chosen_ = best();
      while (swapOne() || swapTwo()) {
      }
      if (chosen_ == before && !replaceOne(list) && !raceMore() && !swapBeside(list) &&
          !(chosen_.empty() && latentForceRemains() && simplify()))
        break;
    }
    // distinctions that rest on unconverged fits
    for (int i = 0; i < 2 && search_.complete(2 * options_.classWidth); ++i)
      search_.enforceNesting();
    return chosen_ = best();
  }

 private:
  // No effect was found, and the latent force is too large for noise of the inputs: the parameters
  // of the base model may be in a wrong minimum, and with them every effect that was fitted from
  // there.
  bool latentForceRemains() const {
    return search_.at({}).fit.noise.latent > options_.latentTolerance;
  }

  // A parameter in error may be a proxy of another one: if all of them are uncertain, the fits have
  // several minima, and those started from the base model found the nearest ones.
  bool onlyParameter() const {
    return chosen_.size() == 1 &&
           search_.data().candidates()[chosen_.front()].kind == EffectKind::parameter;
  }

  // A small latent force may hide an effect from the screening.
  bool raceMore() {
    if (!chosen_.empty()) return false;
    std::vector<std::size_t> list;
    for (const Screened& s : search_.screen({}, true))
      if (s.gain > options_.evidence && list.size() < kMore &&
          search_.entries().count({s.candidate}) == 0)
        list.push_back(s.candidate);
    if (list.empty()) return false;
    search_.race({}, list);
    search_.enforceNesting();
    chosen_ = best();
    return !chosen_.empty();
  }

  // Before a second effect is accepted, single effects are fitted from other starts: from a base
  // model that is far off, the fits may have led to proxies of one effect that explains everything.
  bool simplify() {
    if (search_.hasRacedFromNominal()) return false;
    search_.raceFromNominal(kFromNominal);
    search_.enforceNesting();
    const Effects before = chosen_;
    chosen_ = best();
    return chosen_ != before;
  }

  // The best fitted hypothesis in which every effect is significant and has enough evidence.
  Effects best() const {
    Effects best;
    double score = search_.at({}).score;
    for (const auto& [effects, entry] : search_.entries()) {
      const double net = entry.score - options_.evidence * static_cast<double>(effects.size());
      if (!effects.empty() && net > score && isSignificant(entry)) {
        score = net;
        best = effects;
      }
    }
    return best;
  }

  bool isSignificant(const Entry& entry) const {
    return search_.significance(entry) > options_.significance;
  }

  // Whether a further effect would gain evidence.
  bool promising() {
    search_.simulation(chosen_);
    for (const bool simulation : {false, true})
      for (const Screened& s : search_.screen(chosen_, simulation))
        if (s.gain > 0.6 * options_.evidence) return true;
    return false;
  }

  // Whether a hypothesis was fitted, or is now, from the one without its effect `last`.
  bool mayBeFitted(const Effects& effects, std::size_t last) {
    if (search_.entries().count(effects) > 0) return true;
    const Effects fewer = without(effects, last);
    if (search_.entries().count(fewer) == 0) return false;
    search_.race(fewer, {last});
    return true;
  }

  // With two effects or more, each may be a proxy of another one.
  bool swapOne() {
    if (chosen_.size() < 2) return false;
    const Effects now = chosen_;
    for (const std::size_t effect : now) {
      const Effects rest = without(now, effect);
      if (mayBeFitted(rest, rest.back())) search_.race(rest, search_.shortlist(rest, kRivals));
    }
    search_.enforceNesting();
    chosen_ = best();
    return chosen_ != now;
  }

  // Two effects may be proxies that support each other, so that neither can be replaced alone (e.g.
  // Stribeck friction with an offset of one input, for dry friction with an offset of all).
  bool swapTwo() {
    if (chosen_.size() < 2) return false;
    const Effects now = chosen_;
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t k = i + 1; k < now.size(); ++k) {
        const Effects rest = without(without(now, now[i]), now[k]);
        for (const std::size_t rival : rivalsOf(now, now[i]))
          for (const std::size_t other : rivalsOf(now, now[k])) {
            const Effects first = with(rest, rival);
            if (rival == other || search_.entries().count(with(first, other)) > 0) continue;
            if (mayBeFitted(first, rival)) search_.race(first, {other});
          }
      }
    search_.enforceNesting();
    chosen_ = best();
    return chosen_ != now;
  }

  // The best alternatives that were fitted in the place of one of several effects.
  std::vector<std::size_t> rivalsOf(const Effects& effects, std::size_t effect) const {
    const Effects rest = without(effects, effect);
    std::vector<std::pair<double, std::size_t>> ranked;
    for (const auto& [raced, entry] : search_.entries()) {
      if (raced.size() != effects.size() || raced == effects || !entry.works()) continue;
      for (const std::size_t one : raced)
        if (without(raced, one) == rest) ranked.emplace_back(-entry.score, one);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::size_t> best;
    const bool isFull = static_cast<int>(effects.size()) >= options_.maxEffects;
    const std::size_t partners = kPartners + (isFull && effects.size() > 2 ? 1 : 0);
    for (std::size_t i = 0; i < std::min(ranked.size(), partners); ++i)
      best.push_back(ranked[i].second);
    return best;
  }

  // A further effect that gains almost enough beside these may gain more beside others, of which
  // one of these is a proxy: sub-linear damping of dry friction and drag.
  bool swapBeside(const std::vector<std::size_t>& list) {
    const Effects now = chosen_;
    if (now.empty() || static_cast<int>(now.size()) >= options_.maxEffects) return false;
    std::optional<std::size_t> newcomer;
    double most = search_.at(now).score + kAlmost * options_.evidence;
    for (const std::size_t candidate : list) {
      const auto both = search_.entries().find(with(now, candidate));
      if (both == search_.entries().end() || !(both->second.score > most)) continue;
      most = both->second.score;
      newcomer = candidate;
    }
    if (!newcomer) return false;
    for (const std::size_t old : now) {
      const Effects rest = with(without(now, old), *newcomer);
      if (mayBeFitted(rest, *newcomer)) search_.race(rest, search_.shortlist(rest, kRivals));
    }
    search_.enforceNesting();
    chosen_ = best();
    return chosen_ != now;
  }

  // A new effect that gains much but makes an earlier one superfluous replaces it.
  bool replaceOne(const std::vector<std::size_t>& list) {
    const double score = search_.at(chosen_).score;
    for (const std::size_t newcomer : list) {
      const Effects both = with(chosen_, newcomer);
      if (!(search_.at(both).score > score + options_.evidence)) continue;
      for (const std::size_t old : chosen_) {
        search_.drop(both, old);
        const Entry& entry = search_.at(without(both, old));
        if (entry.score > score && isSignificant(entry)) {
          chosen_ = entry.effects;
          return true;
        }
      }
    }
    return false;
  }

  Search& search_;
  const Options& options_;
  Effects chosen_;
};

}  // namespace

Effects select(Search& search, const Options& options) {
  return Selection(search, options).run();
}

}  // namespace info::discover
