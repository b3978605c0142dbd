#pragma once

#include <Eigen/Dense>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// An effect as it may be there: a candidate and values of its quantities, the amplitude first.
struct PresentEffect {
  std::size_t candidate = 0;
  Eigen::VectorXd values;
};

/// What an experiment would tell of two effects before anything has been measured.
struct Distinction {
  /// Nats by which the first one, if it is there, is expected to beat the second, and the reverse
  double firstOverSecond = 0, secondOverFirst = 0;
  /// Standard deviations to which each one's amplitude would be known, the other one and all that
  /// the base model does not know being unknown as well [unit of the amplitude]
  double firstDeviation = 0, secondDeviation = 0;
  double least() const;  ///< nats, the smaller of both
};

/// With Δ_A = y(A) − y(base) over all trials, Γ_0 the nuisances (starts among them) and Γ_B what
/// the other effect may adjust, all in units of their priors,
///     nats(A over B) = ½ Δ_Aᵀ S⁻¹ Δ_A,   S = σ_y² + Γ_0Γ_0ᵀ + Γ_BΓ_Bᵀ
/// the cost that remains when B and the base model do what they can to look like A; exact where
/// outputs are linear. Γ_B is taken with B present, its amplitude along Δ_B, Γ_0 without either.
/// The deviation of A's amplitude a is a/√(2·nats).
/// @param planned  trials that are planned; what was measured in them is not looked at, but for
/// starts
/// @throws std::invalid_argument if both are the same candidate, a candidate or a number of values
///   is wrong, an amplitude is that of absence, or σ_y is not > 0
/// @throws std::domain_error if one of them cannot be simulated
Distinction distinction(const DiscoveryProblem& planned, const PresentEffect& first,
                        const PresentEffect& second, double outputSd);

}  // namespace info::discover
