#pragma once

#include <string>
#include <vector>

#include "info/discovery/discover.h"

namespace info::discover {

/// A fitted quantity beside its prior.
struct FittedNumber {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  std::string name;
  std::string unit;     ///< of the next four; "" if dimensionless
  double nominal = 0;   ///< value in the model
  double estimate = 0;  ///< fitted value
  double sd = 0;        ///< standard deviation of the estimate; NaN: unknown
  double prior = 0;     ///< prior standard deviation; NaN: no prior
  /// Difference of estimate and nominal value in prior standard deviations, of the logarithm if the
  /// prior is log-normal; NaN: no prior
  double priorZ = 0;
};

/// Every quantity that a verdict fitted, each once: those of the effects, the nuisance parameters
/// and the initial states of the trials (as the sensor shows them). Empty if no base model was
/// fitted.
std::vector<FittedNumber> fittedNumbers(const DiscoveryProblem& data, const Verdict& verdict);

}  // namespace info::discover
