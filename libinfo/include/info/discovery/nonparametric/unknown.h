#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/discovery/likelihood/joint_fit.h"
#include "info/discovery/nonparametric/time_tie.h"

namespace info::discover {

/// A term of the formula for the missing force.
struct SymbolicTerm {
  std::string name;        ///< e.g. "q̇|q̇|"
  std::string expression;  ///< in q and qdot, "qdot*abs(qdot)"; empty: not a function of the state
  double coefficient = 0, sd = 0;
  double stability = 0;  ///< fraction of block bootstraps that select it

  /// "-1.48·q³"; for the constant term "1" the number alone.
  static std::string times(double coefficient, const std::string& name);
};

/// Description of a missing effect that is not in the catalogue.
///
/// The formula is a sum of at most three of {1, q, q², q³, q̇, q̇|q̇|, q̇³, tanh(q̇/s), q·q̇, sin q,
/// cos q, u_i, M_i, ∫M_i dt}: q the position of the axis, s its Axis::smallSpeed, sin and cos where
/// q is in radians, u_i the inputs, M_i the moments of the driven actuators about it if the latent
/// force has a channel for each. Its terms are forces
/// at the nodes of that axis; with their score g and information S, after elimination of all
/// quantities that are free in the fit and with the latent force in the covariance, the subset with
/// the largest evidence is taken,
///     ½ gᵀS⁻¹g − ½ k·log n   (k terms, n samples; Schwarz),
/// so that an error of a parameter does not appear as a formula.
struct Unknown {
  /// The axis whose force is described: that with the most certain latent force, the largest
  /// Σ (d/its standard deviation)² over its nodes.
  std::size_t axis = 0;
  double peakFrequency = 0;  ///< [Hz] peak of the latent force's spectrum, relative to its prior
  double peakShare = 0;      ///< fraction of its power within ±0.5 Hz of the peak
  double forceSize = 0;      ///< root mean square [unit of the generalised force]
  TimeTie tie;               ///< of the force to the time since the trials' zero
  std::vector<SymbolicTerm> terms;  ///< best subset, at most three terms, the most certain first
  double evidence = 0;   ///< log Bayes factor of the terms against the latent force alone [nats]
  double explained = 0;  ///< fraction of the latent force's power that they explain
  bool stable = false;   ///< every term selected in 90 % of the bootstraps
  std::string formula;   ///< e.g. "−0.42·q̇|q̇| + 0.1·q"
};

/// The latent force of a fit on the axis of Unknown::axis.
struct RemainingForce {
  std::size_t axis = 0;
  double size = 0;  ///< root mean square over all nodes [unit of the generalised force]
};
RemainingForce strongestForce(const Likelihood& likelihood, const Fit& fit);

/// @param fit of the base model with a latent force of the estimated size
Unknown describeUnknown(const Likelihood& likelihood, const Fit& fit);

}  // namespace info::discover
