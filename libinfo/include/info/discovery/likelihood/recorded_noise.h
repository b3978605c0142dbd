#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "info/discovery/judgement/output_sd.h"

namespace info::discover {

/// The noise of the samples, estimated from the samples themselves. All inference assumes
/// independent normal noise; this selects the samples for which the assumption holds.
struct RecordedNoise {
  OutputSd sd;               ///< σ_y of the kept samples
  int spacing = 1;           ///< every spacing-th sample is kept because of correlated noise
  double interval = 0;       ///< between those [s], if `spacing` > 1
  double quantum = 0;        ///< quantisation step of the output; 0: negligible
  double reduced = 1;        ///< by which the residual of a first search reduced σ_y
  std::size_t outliers = 0;  ///< number of excluded outliers
  std::size_t samples = 0;   ///< that there are
  std::vector<std::vector<std::size_t>> kept;  ///< indices of the samples to use, by trial
  /// Whether every sample is used.
  bool usesAll() const { return outliers == 0 && spacing == 1; }
  /// Error of quantisation, below which no σ_y is estimated: quantum/√12.
  double leastSd() const { return quantum / std::sqrt(12.0); }
  /// Reduces σ_y by a factor.
  void reduce(double factor) {
    sd.value = sd.value.scaled(factor);
    reduced *= factor;
  }
};

/// Outliers are samples more than 8 robust standard deviations off the parabola through their
/// neighbours (least absolute deviations of four on each side), if the samples are dense enough for
/// a parabola to follow the motion. If more than a sixth of all samples were outliers, none is
/// excluded.
///
/// Correlation shows in third differences over m samples, σ_m² = Σ(y_k − 3y_{k−m} + 3y_{k−2m} −
/// y_{k−3m})²/20n of the residuals of a nudged model (DiscoveryProblem::nudged): σ_m is the same
/// for every m if the noise is white, and grows with m while the noise is correlated over m
/// samples. The smallest m with σ_2m ≤ 1.15 σ_m is taken. If nudging is not available, the noise is
/// assumed white.
///
/// σ_y is that of third differences (output_deviation.h), or σ_m if samples are excluded because of
/// correlation, and at least the quantisation error, quantum/√12.
/// @param trials the trials to estimate from; `kept` has all trials
/// @param givenSd  σ_y if it is known: taken where the samples are too sparse to tell it
/// @throws std::invalid_argument what estimateOutputSd throws, without a givenSd
RecordedNoise recordedNoise(const DiscoveryProblem& data, const std::vector<int>& trials,
                            const std::optional<Whitening>& givenSd = {});

}  // namespace info::discover
