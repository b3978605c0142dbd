#pragma once

#include <Eigen/Dense>
#include <string>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// Expected log Bayes factor [nats] ≥ 0 between two hypotheses in a planned experiment.
///
/// Both hypotheses are used as fitted to the present data: y_A, y_B at their estimates, Γ_A, Γ_B
/// with their posterior covariances, the initial states of the new trials with their priors, and
/// the latent force W with the larger σ_d. With
///     S = σ_y² + Γ_A cov(ξ_A) Γ_Aᵀ + Γ_B cov(ξ_B) Γ_Bᵀ + Γ_0 Γ_0ᵀ + WWᵀ
/// it is ½ Σ_trials (y_A − y_B)ᵀ S⁻¹ (y_A − y_B): the difference that remains after each hypothesis
/// has adjusted within its posterior. The correlation of both posteriors (they come from the same
/// data) is neglected, so the true value is likely larger.
///
/// @param planned the planned trials, with the experimental changes; of their measurements only the
///   initial states are used. Quantities of `fitted` that belong to no trial are looked up in it by
///   name.
/// @param fitted the data that a and b were fitted to
/// @throws std::invalid_argument if a quantity is missing in `planned`
/// @throws std::domain_error if one of them cannot be simulated there
double expectedSeparation(const DiscoveryProblem& planned, const DiscoveryProblem& fitted,
                          const Fit& a, const Fit& b);

/// Names of the effects of one of Verdict::rivals that the first of them lacks, e.g. "tilt + visc".
std::string rivalName(const DiscoveryProblem& data, const Verdict& verdict, std::size_t rival);

}  // namespace info::discover
