#pragma once

#include <cstddef>
#include <vector>

#include "info/discovery/judgement/output_sd.h"

namespace info::discover {

/// What the samples themselves say about their noise. Everything that is concluded from them takes
/// their noise for independent and normal; this says which of them may be taken so.
struct RecordedNoise {
  OutputSd sd;               ///< σ_y of the samples that are kept
  int spacing = 1;           ///< every so many-th sample is kept, their noise being correlated
  double interval = 0;       ///< between those [s], where `spacing` > 1
  double quantum = 0;        ///< step in which the output is written; 0: none that matters
  std::size_t outliers = 0;  ///< samples that are left out as such
  std::size_t samples = 0;   ///< that there are
  std::vector<std::vector<std::size_t>> kept;  ///< by trial: indices of the samples to use
  /// Every sample is used.
  bool usesAll() const { return outliers == 0 && spacing == 1; }
};

/// Outliers are samples more than 8 robust deviations off the parabola through their neighbours
/// (least absolute deviations of four on each side), where samples lie so close that a parabola
/// follows the motion; more than a sixth of all are none.
///
/// Correlation shows in third differences over m samples, σ_m² = Σ(y_k − 3y_{k−m} + 3y_{k−2m} −
/// y_{k−3m})²/20n of what a model leaves that is held near the data (DiscoveryProblem::nudged): σ_m
/// is the same for every m where noise is white and grows where it is correlated over m samples.
/// The least m with σ_2m ≤ 1.15 σ_m is taken. Where holding is not offered the noise is taken for
/// white.
///
/// σ_y is that of third differences (output_deviation.h), of σ_m where samples are left out for
/// their correlation, and not below what rounding makes of it, the quantum/√12.
/// @param trials  to estimate from; `kept` has all trials
/// @throws std::invalid_argument what estimateOutputSd throws
RecordedNoise recordedNoise(const DiscoveryProblem& data, const std::vector<int>& trials);

}  // namespace info::discover
