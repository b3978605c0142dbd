#pragma once

#include <Eigen/Dense>
#include <vector>

namespace info {

/// Autocorrelation of residuals at lags 0 … maxLag,
///     ρ_k = [ Σ r_i r_{i+k} / n_k ] / [ Σ r_i² / n ]
/// n_k: number of pairs. The mean is not removed, since residuals of a correct model have zero
/// mean. Series are separate recordings; pairs do not extend from one to another.
/// @param series residuals in the order of time, equally spaced
/// @throws std::invalid_argument if there is no residual, or all are 0
std::vector<double> autocorrelation(const std::vector<Eigen::VectorXd>& series,
                                    Eigen::Index maxLag);

/// Integrated autocorrelation time, the number of residuals per independent value: τ = 1 + 2Σρ_k,
/// summed up to the first lag with ρ_k below 2/√n, which white noise exceeds in one case of forty.
/// τ = 1 for white noise; never less.
/// @param rho the result of autocorrelation()
/// @param samples n, the total of all series
double autocorrelationTime(const std::vector<double>& rho, Eigen::Index samples);

/// Robust standard deviation of residuals about 0 with outliers: 1.4826·median|r|, consistent for
/// normal residuals.
double robustSd(const Eigen::VectorXd& residuals);

}  // namespace info
