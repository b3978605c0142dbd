#pragma once

#include <Eigen/Dense>
#include <string>

#include "info/discovery/discover.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

/// How well an experiment that has not been done yet would tell two hypotheses apart: the log Bayes
/// factor to be expected [nats], 0 or more.
///
/// Both are taken as the data have left them: y_A, y_B at their estimates, Γ_A, Γ_B with their
/// posterior covariances, starts of the new trials as uncertain as before any data, and the latent
/// force W of the larger σ_d. With
///     S = σ_y² + Γ_A cov(ξ_A) Γ_Aᵀ + Γ_B cov(ξ_B) Γ_Bᵀ + Γ_0 Γ_0ᵀ + WWᵀ
/// it is ½ Σ_trials (y_A − y_B)ᵀ S⁻¹ (y_A − y_B): what remains of the difference when each may
/// adjust as far as it still can. That the uncertainties of both are correlated (they come from the
/// same data) is left aside, so the true value is rather larger.
///
/// @param planned  trials that are planned, with what the experimenter changes in them; what was
///   measured in them is not looked at, but for the starts. Quantities of `fitted` that belong to
///   no trial are found in it by name.
/// @param fitted   what a and b were fitted to
/// @throws std::invalid_argument if a quantity is missing in `planned`
/// @throws std::domain_error if one of them cannot be simulated there
double expectedSeparation(const DiscoveryProblem& planned, const DiscoveryProblem& fitted,
                          const Fit& a, const Fit& b);

/// "tilt + visc" of one of Verdict::rivals, without what the first of them has, too.
std::string rivalName(const DiscoveryProblem& data, const Verdict& verdict, std::size_t rival);

}  // namespace info::discover
