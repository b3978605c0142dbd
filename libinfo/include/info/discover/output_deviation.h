#pragma once

#include <vector>

#include "info/discover/disagreement.h"

namespace info::discover {

/// σ_y from the third differences of equally spaced samples, Σ(Δ³y)²/20: exact for noise on a curve
/// that a parabola follows over four samples; slower curves add little.
struct OutputDeviation {
  double value = 0;
  double relativeError = 0;  ///< standard error of value²/value², for noise
};
/// @throws std::invalid_argument if no four samples are equally spaced
OutputDeviation estimateOutputDeviation(const Disagreement& data, const std::vector<int>& trials);

}  // namespace info::discover
