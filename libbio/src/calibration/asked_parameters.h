#pragma once

// Not public.

#include <string>
#include <vector>

#include "bio/calibration/calibrate.h"

namespace bio {

/// The numbers that a calibration estimates, as its options ask for them.
struct AskedParameters {
  std::vector<info::Parameter> parameters;  ///< start, bounds, prior
  Eigen::VectorXd priorSds;                 ///< prior standard deviations
};

/// @throws std::invalid_argument what calibrate() throws of them
AskedParameters askedParameters(const TrialSet& training, const TrialSet* heldOut,
                                const CalibrationOptions& options);

/// Place of a parameter of the model among the numbers that are estimated.
/// @param what  for the message, e.g. "prior"
/// @throws std::invalid_argument if it is not among them
std::size_t placeOfParameter(const TrialSet& training, const std::string& name, const char* what);

/// @throws std::invalid_argument naming the option, its value and the rule that it breaks
void requireValid(const CalibrationOptions& options);

}  // namespace bio
