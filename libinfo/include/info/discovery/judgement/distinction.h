#pragma once

#include <Eigen/Dense>

#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/whitening.h"

namespace info::discover {

/// A hypothetical effect: a candidate and values of its quantities, the amplitude first.
struct PresentEffect {
  std::size_t candidate = 0;
  Eigen::VectorXd values;
};

/// The expected discrimination of two effects by a planned experiment.
struct Distinction {
  /// Expected log Bayes factor [nats] of the first effect over the second if the first is present,
  /// and the reverse
  double firstOverSecond = 0, secondOverFirst = 0;
  /// Expected standard deviation of each amplitude, with the other effect and the base model's
  /// uncertain parameters unknown as well [unit of the amplitude]
  double firstDeviation = 0, secondDeviation = 0;
  double least() const;  ///< [nats], the smaller of the two
};

/// With Δ_A = y(A) − y(base) over all trials, Γ_0 the sensitivities to the nuisance parameters
/// (with the initial states) and Γ_B those to the quantities of the other effect, all in units of
/// their priors and of the outputs' noise,
///     nats(A over B) = ½ Δ_Aᵀ S⁻¹ Δ_A,   S = 1 + Γ_0Γ_0ᵀ + Γ_BΓ_Bᵀ
/// the minimal cost of fitting A's outputs by B and the base model; exact for linear outputs. Γ_B
/// is taken with B present, its amplitude along Δ_B, Γ_0 without either. The deviation of A's
/// amplitude a is a/√(2·nats).
/// @param planned the planned trials; of their measurements only the initial states are used
/// @throws std::invalid_argument if both are the same candidate, a candidate or a number of values
///   is wrong, an amplitude has the value of an absent effect, or σ_y is not > 0
/// @throws std::domain_error if one of them cannot be simulated
Distinction distinction(const DiscoveryProblem& planned, const PresentEffect& first,
                        const PresentEffect& second, const Whitening& sds);

}  // namespace info::discover
