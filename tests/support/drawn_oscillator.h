#pragma once

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "support/linear_problem.h"

namespace support {

/// Deviations of drawn(): of the output, of the latent force, and that force's time [s].
inline constexpr double kOutput = 0.02, kLatent = 0.3, kTime = 0.1;

/// Two trials of 80 samples of the oscillator with a push and a gain.
inline LinearDisagreement drawn(std::uint64_t seed, double push, double gain) {
  LinearDisagreement data(2, 80);
  Eigen::VectorXd truth = info::discover::nominalValues(data);
  truth[0] = gain;
  truth[1] = push;
  data.draw(seed, truth, kOutput, kLatent, kTime);
  return data;
}

/// What the engine is told of drawn().
inline info::discover::Options optionsOfDrawn() {
  info::discover::Options options;
  options.sds = kOutput;
  options.latentScale = 1;
  options.latentTime = kTime;
  options.latentTolerance = 0.6;
  return options;
}

}  // namespace support
