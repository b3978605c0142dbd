#pragma once

#include <Eigen/Dense>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/whitening.h"

namespace info::discover {

/// Third differences of samples that are equally spaced, Σ(Δ³y)²; differences over a gap, a value
/// that is not finite or another spacing are omitted. Where most samples are not equally spaced, as
/// of an output that is slower than the rows of its table, divided differences of four samples
/// whose intervals differ by a factor of at most 3.5 are taken as well, scaled to the same
/// variance.
struct ThirdDifferences {
  double squares = 0;
  double count = 0;
  /// @param times  [s], as many as values
  void add(const std::vector<double>& times, const Eigen::Ref<const Eigen::VectorXd>& values);
  /// σ_y² of white noise: third differences have twenty times its variance.
  double sd() const;
};

/// Third differences of each output of these trials.
std::vector<ThirdDifferences> differencesOf(const DiscoveryProblem& data,
                                            const std::vector<int>& trials);

/// σ_y of each output from the third differences of equally spaced samples, Σ(Δ³y)²/20: exact for
/// noise on a curve that is a parabola over any four samples; smooth curves add little.
struct OutputSd {
  Whitening value;
  double relativeError = 0;  ///< standard error of value²/value², for noise, of all outputs
};
/// @throws std::invalid_argument if an output has no four such samples
OutputSd estimateOutputSd(const DiscoveryProblem& data, const std::vector<int>& trials);

}  // namespace info::discover
