#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "info/information/output_covariance.h"

namespace info {

/// The Γ_k stacked: sample k in rows k·h … k·h+h−1.
/// @throws std::invalid_argument if the Γ_k differ in size
Eigen::MatrixXd stack(const std::vector<Eigen::MatrixXd>& gamma_k);

/// Fisher information of samples about parameters,
///     I = Σ_k Γ_kᵀ Σ_k⁻¹ Γ_k
/// Γ_k = dy_k/dθ (outputs × parameters), Σ_k the covariance of the noise on y_k. Samples and
/// outputs that were not observed contribute nothing; a partly observed sample contributes with its
/// marginal covariance.
///
/// Wilson's thesis (4.1), there for one Σ and no gaps. Symmetric, positive semidefinite,
/// [1/(unit_i·unit_j)].
/// @param gamma stacked Γ_k: (outputs·samples) × parameters
/// @throws std::invalid_argument if the shapes do not fit; std::domain_error if Γ is not finite
Eigen::MatrixXd fisherInformation(const Eigen::MatrixXd& gamma, const OutputCovariance& covariance,
                                  const ObservationMask& observed = {});
Eigen::MatrixXd fisherInformation(const std::vector<Eigen::MatrixXd>& gamma_k,
                                  const OutputCovariance& covariance,
                                  const ObservationMask& observed = {});

/// Cramér–Rao bound I⁻¹: no unbiased estimator has a smaller covariance. Wilson's thesis (2.1).
///
/// @param names of the parameters, for messages; empty: θ0, θ1, …
/// @throws std::invalid_argument if I is not square, or not symmetric but for rounding;
///         std::domain_error if I is not finite, if a parameter has no information at all (named),
///         or if I is singular to working accuracy after scaling each parameter to unit information
///         (the combination is named; identifiability.h tells more)
Eigen::MatrixXd cramerRaoBound(const Eigen::MatrixXd& information,
                               const std::vector<std::string>& names = {});

}  // namespace info
