#include "info/discovery/likelihood/fitted_numbers.h"

#include <algorithm>

namespace info::discover {

std::vector<FittedNumber> fittedNumbers(const DiscoveryProblem& data, const Verdict& verdict) {
  std::vector<FittedNumber> numbers;
  const auto add = [&](const std::vector<Estimate>& estimates) {
    for (const Estimate& estimate : estimates) {
      if (std::any_of(numbers.begin(), numbers.end(), [&](const FittedNumber& known) {
            return known.quantity == estimate.quantity;
          }))
        continue;
      const Quantity& quantity = data.quantities()[estimate.quantity];
      const double prior = quantity.sd * (quantity.logarithmic ? quantity.nominal : 1);
      numbers.push_back({estimate.quantity, quantity.name, quantity.unit, quantity.nominal,
                         estimate.value, estimate.sd, prior, estimate.priorZ});
    }
  };
  for (const NamedEffect& effect : verdict.effects) add(effect.estimates);
  add(verdict.nuisancesAfter);
  add(verdict.heldOutStarts);
  return numbers;
}

}  // namespace info::discover
