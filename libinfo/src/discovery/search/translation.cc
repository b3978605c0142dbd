#include "discovery/search/translation.h"

#include <algorithm>

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

std::optional<std::size_t> placeOf(const DiscoveryProblem& data, const std::string& id) {
  for (std::size_t c = 0; c < data.candidates().size(); ++c)
    if (data.candidates()[c].id == id) return c;
  return {};
}

namespace {

// Translation of quantities to a catalogue with fewer effects and a formula.
class Translation {
 public:
  Translation(const DiscoveryProblem& from, const DiscoveryProblem& to) : from_(from), to_(to) {
    for (const Quantity& wanted : to.quantities()) {
      const auto& quantities = from.quantities();
      const auto found = std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& q) {
        return q.name == wanted.name && q.trial == wanted.trial;
      });
      source_.push_back(found == quantities.end() ? -1 : found - quantities.begin());
    }
  }

  // Quantities that the other catalogue lacks are nominal.
  VectorXd values(const VectorXd& old) const {
    VectorXd result = nominalValues(to_);
    for (std::size_t i = 0; i < source_.size(); ++i)
      if (source_[i] >= 0) result[static_cast<Index>(i)] = old[source_[i]];
    return result;
  }

  // Empty if one of them is missing.
  std::optional<Effects> effects(const Effects& old) const {
    Effects result;
    for (const std::size_t e : old) {
      const auto place = placeOf(to_, from_.candidates()[e].id);
      if (!place) return {};
      result.push_back(*place);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  std::optional<Entry> entry(const Entry& old, const std::vector<int>& trials) const {
    const auto renamed = effects(old.effects);
    if (!renamed) return {};
    Entry result = old;
    result.effects = *renamed;
    result.simulation.reset();
    Fit& fit = result.fit;
    fit.hypothesis = makeHypothesis(to_, *renamed, trials);
    fit.values = values(old.fit.values);
    std::vector<Index> order;
    for (std::size_t i = 0; i < fit.hypothesis.free.size(); ++i) {
      const Index source = source_[fit.hypothesis.free[i].quantity];
      const int at = source < 0 ? -1 : old.fit.hypothesis.indexOf(static_cast<std::size_t>(source));
      if (at < 0) return {};
      order.push_back(at);
      fit.atBound[i] = old.fit.atBound[static_cast<std::size_t>(at)];
    }
    fit.xi = old.fit.xi(order);
    fit.covariance = old.fit.covariance(order, order);
    return result;
  }

 private:
  const DiscoveryProblem& from_;
  const DiscoveryProblem& to_;
  std::vector<Index> source_;  // source of each quantity of the other catalogue, or −1
};

}  // namespace

std::optional<SearchMemory> searchMemoryOf(const Search& search, const Effects& chosen,
                                           const DiscoveryProblem& widened) {
  const Translation translation(search.data(), widened);
  SearchMemory memory;
  for (const auto& [effects, old] : search.entries()) {
    if (!old.works() ||
        !std::includes(chosen.begin(), chosen.end(), effects.begin(), effects.end()))
      continue;
    auto entry = translation.entry(old, search.likelihood().trials());
    if (!entry) return {};
    if (effects == chosen) memory.chosen = entry->effects;
    memory.entries.emplace(entry->effects, std::move(*entry));
  }
  memory.scaleValues = translation.values(search.scaleValues());
  memory.racedFromNominal = search.hasRacedFromNominal();
  return memory;
}

}  // namespace info::discover
