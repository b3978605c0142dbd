#pragma once

#include <string>
#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// A number that was fitted, beside what was known of it before.
struct FittedNumber {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  std::string name;
  std::string unit;     ///< of the four that follow; "" for a pure number
  double nominal = 0;   ///< as the model had it
  double estimate = 0;  ///< as it is now
  double sd = 0;        ///< standard deviation of the estimate; NaN: not known
  double prior = 0;     ///< standard deviation of what was known beforehand; NaN: nothing was
  /// How many of those the estimate is away from what was known, of the logarithm where that is
  /// normal; NaN: nothing was known
  double priorZ = 0;
};

/// Every number that a verdict fitted: the effects' quantities, the nuisances, the trials' starts
/// (a start as the sensor shows it), each once. Empty before there was a base model.
std::vector<FittedNumber> fittedNumbers(const DiscoveryProblem& data, const Verdict& verdict);

}  // namespace info::discover
