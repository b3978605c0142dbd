#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// A term of a formula for the force that is missing.
struct SymbolicTerm {
  std::string name;        ///< e.g. "q̇|q̇|"
  std::string expression;  ///< in q and qdot, "qdot*abs(qdot)"; empty: it does not follow the state
  double coefficient = 0, sd = 0;
  double stability = 0;  ///< share of block bootstraps that select it

  /// "-1.48·q³"; of the name "1" the number alone.
  static std::string times(double coefficient, const std::string& name);
};

/// What can be said of an effect that has no name.
///
/// The formula is a sum of at most three of {1, q, q², q³, q̇, q̇|q̇|, q̇³, tanh(q̇/0.05), q·q̇, sin q,
/// cos q, u_i, M_i, ∫M_i dt}: q the first output, u_i the inputs, M_i the moments of what they
/// drive where the latent force has a channel for each. Its terms are forces at the latent nodes;
/// with their score g and information S, all that is free in the fit projected out and the latent
/// force in the covariance, the subset with most evidence is taken,
///     ½ gᵀS⁻¹g − ½ k·log n   (k terms, n samples; Schwarz),
/// so that nothing is a formula that a parameter could imitate.
struct Unknown {
  double peakFrequency = 0;         ///< [Hz] of the latent force, relative to its prior
  double peakShare = 0;             ///< of its power within ±0.5 Hz of the peak
  double forceSize = 0;             ///< root mean square [unit of the generalised force]
  std::vector<SymbolicTerm> terms;  ///< best subset, at most three, the most certain first
  double evidence = 0;              ///< of them, against the latent force alone [nats]
  double explained = 0;             ///< share of the latent force's power that they take away
  bool stable = false;              ///< every term in 90 % of the bootstraps
  std::string formula;              ///< e.g. "−0.42·q̇|q̇| + 0.1·q"
};

/// @param fit of the base model with the latent force that the data ask for
Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
