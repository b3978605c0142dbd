#include "discovery/search/select.h"

#include <algorithm>

namespace info::discover {
namespace {

constexpr std::size_t kFromNominal = 4;  // single names that are raced once more
// How many are raced in the place of one of several names: of five, const was none beside fatigue
// (set 61112 of validation/discovery).
constexpr int kRivals = 7;
constexpr std::size_t kPartners = 2;  // rivals of each of two names that are tried together

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
      for (int attempt = 0; attempt < 3; ++attempt) {
        list = search_.shortlist(chosen_, first ? options_.finalists : 5);
        search_.race(chosen_, list);
        if (!search_.refitBase(chosen_)) break;
      }
      search_.enforceNesting();
      const Effects before = chosen_;
      chosen_ = best();
      while (swapOne() || swapTwo()) {
      }
      if (chosen_ == before && !replaceOne(list) &&
          !(chosen_.empty() && latentForceRemains() && simplify()))
        break;
    }
    // names that are told apart by fits which were not done
    for (int i = 0; i < 2 && search_.complete(2 * options_.classWidth); ++i)
      search_.enforceNesting();
    return chosen_ = best();
  }

 private:
  // Without any name, and with a latent force that no noise of the inputs explains: the base may
  // have run away, and every effect that was raced from there with it (sets 66012 and 66155).
  bool latentForceRemains() const {
    return search_.at({}).fit.noise.latent > options_.latentTolerance;
  }

  // A parameter that is said to be off may stand for another one: where all of them are uncertain,
  // the fits have several minima, and what was raced from the base's found the nearest ones.
  bool onlyParameter() const {
    return chosen_.size() == 1 &&
           search_.data().candidates()[chosen_.front()].kind == EffectKind::parameter;
  }

  // Before a second name is given, single ones are tried from elsewhere: a base that is far off may
  // have led to makeshifts for one effect that explains everything.
  bool simplify() {
    if (search_.hasRacedFromNominal()) return false;
    search_.raceFromNominal(kFromNominal);
    search_.enforceNesting();
    const Effects before = chosen_;
    chosen_ = best();
    return chosen_ != before;
  }

  // The best of all that have been raced where every effect is significant and earns its place.
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

  // Is anything to be gained beyond what has been chosen?
  bool promising() {
    search_.simulation(chosen_);
    for (const bool simulation : {false, true})
      for (const Screened& s : search_.screen(chosen_, simulation))
        if (s.gain > 0.6 * options_.evidence) return true;
    return false;
  }

  // With two effects or more, each may have been a makeshift for something else.
  bool swapOne() {
    if (chosen_.size() < 2) return false;
    const Effects now = chosen_;
    for (const std::size_t effect : now) {
      const Effects rest = without(now, effect);
      if (search_.entries().count(rest) == 0) {
        const Effects fewer = without(rest, rest.back());
        if (search_.entries().count(fewer) == 0) continue;
        search_.race(fewer, {rest.back()});
      }
      search_.race(rest, search_.shortlist(rest, kRivals));
    }
    search_.enforceNesting();
    chosen_ = best();
    return chosen_ != now;
  }

  // Two names may be makeshifts for each other's sake, so that neither gives way alone (Stribeck
  // friction and one muscle's baseline for dry friction and the baseline of all, set 63112).
  bool swapTwo() {
    if (chosen_.size() < 2) return false;
    const Effects now = chosen_;
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t k = i + 1; k < now.size(); ++k) {
        const Effects rest = without(without(now, now[i]), now[k]);
        for (const std::size_t one : rivalsOf(now, now[i]))
          for (const std::size_t other : rivalsOf(now, now[k])) {
            const Effects first = with(rest, one);
            if (one == other || search_.entries().count(with(first, other)) > 0) continue;
            if (search_.entries().count(first) == 0) {
              if (search_.entries().count(rest) == 0) continue;
              search_.race(rest, {one});
            }
            search_.race(first, {other});
          }
      }
    search_.enforceNesting();
    chosen_ = best();
    return chosen_ != now;
  }

  // The best of what has been raced in the place of one of several.
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
    for (std::size_t i = 0; i < std::min(ranked.size(), kPartners); ++i)
      best.push_back(ranked[i].second);
    return best;
  }

  // A newcomer that helps much but leaves nothing to one of those before it takes its place.
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
