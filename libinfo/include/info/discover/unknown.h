#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discover/joint_fit.h"

namespace info::discover {

/// A term of a formula for the force that is missing.
struct SymbolicTerm {
  std::string name;  ///< e.g. "q̇|q̇|"
  double coefficient = 0, deviation = 0;
  double stability = 0;  ///< share of block bootstraps that select it
};

/// What can be said of an effect that has no name.
struct Unknown {
  double peakFrequency = 0;         ///< [Hz] of the latent force, relative to its prior
  double peakShare = 0;             ///< of its power within ±0.5 Hz of the peak
  double forceSize = 0;             ///< root mean square [unit of the generalised force]
  std::vector<SymbolicTerm> terms;  ///< best subset, at most three
  double explained = 0;             ///< share of the latent force's power that they explain
  bool stable = false;              ///< every term in 90 % of the bootstraps
  std::string formula;              ///< e.g. "−0.42·q̇|q̇| + 0.1·q"
};

/// @param fit of the base model with the latent force that the data ask for
Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
