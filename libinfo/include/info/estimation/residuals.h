#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info {

/// Autocorrelation of residuals at lags 0 … maxLag,
///     ρ_k = [ Σ r_i r_{i+k} / n_k ] / [ Σ r_i² / n ]
/// n_k: number of pairs. The mean is not removed: residuals of a model that fits have none. Series
/// are recorded apart, no pair reaches from one to another.
/// @param series residuals in the order of time, equally spaced
/// @throws std::invalid_argument if there is no residual, or all are 0
std::vector<double> autocorrelation(const std::vector<Eigen::VectorXd>& series,
                                    Eigen::Index maxLag);

/// How many residuals count as one independent value: τ = 1 + 2Σρ_k, summed up to the first lag
/// with ρ_k below 2/√n, which white noise exceeds in one case of forty. τ = 1 for white noise;
/// never less.
/// @param rho     as autocorrelation() gives it
/// @param samples n, of all series together
double autocorrelationTime(const std::vector<double>& rho, Eigen::Index samples);

/// Standard deviation from the median of |r|, for residuals about 0 with outliers among them:
/// 1.4826·median|r|, exact for normal ones.
double robustSd(const Eigen::VectorXd& residuals);

}  // namespace info
