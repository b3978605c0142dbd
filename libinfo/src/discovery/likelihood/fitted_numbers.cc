#include "info/discovery/likelihood/fitted_numbers.h"

#include <algorithm>

namespace info::discover {

std::vector<FittedNumber> fittedNumbers(const DiscoveryProblem& data, const Verdict& verdict) {
  std::vector<FittedNumber> numbers;
  const auto add = [&](const std::vector<Estimate>& estimates) {
    for (const Estimate& one : estimates) {
      if (std::any_of(numbers.begin(), numbers.end(),
                      [&](const FittedNumber& known) { return known.quantity == one.quantity; }))
        continue;
      const Quantity& quantity = data.quantities()[one.quantity];
      const double prior = quantity.sd * (quantity.logarithmic ? quantity.nominal : 1);
      numbers.push_back({one.quantity, quantity.name, quantity.unit, quantity.nominal, one.value,
                         one.sd, prior, one.surprise});
    }
  };
  for (const NamedEffect& effect : verdict.effects) add(effect.estimates);
  add(verdict.nuisancesAfter);
  add(verdict.heldOutStarts);
  return numbers;
}

}  // namespace info::discover
