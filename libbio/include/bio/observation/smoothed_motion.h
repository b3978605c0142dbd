#pragma once

#include <Eigen/Dense>
#include <vector>

namespace bio {

/// A smoothed measured course on a uniform grid.
struct SmoothedMotion {
  std::vector<double> times;  ///< [s] `spacing` apart, from the first sample to the last or just
                              ///< behind it
  Eigen::VectorXd values;     ///< unit of the measurement
  Eigen::VectorXd speeds;     ///< [1/s of that]
};

/// Penalised least squares (Whittaker 1923, Henderson 1924) on a grid of spacing Δ:
///     Σ_k (y_k − c(t_k))² + μ Σ_j (Δ³c_j)² → min,   c linear between grid points
/// with μ = (2 sin π f Δ)⁻⁶, so that a sine of frequency f in uniformly sampled data is reduced to
/// half its amplitude. Gaps are bridged by parabolas.
/// @param times     [s], strictly rising, at least four
/// @param values    as many, finite
/// @param cutoff    f [Hz] > 0
/// @param spacing   Δ [s], 0 < 2 f Δ < 1
/// @throws std::invalid_argument for invalid arguments
SmoothedMotion smoothed(const std::vector<double>& times, const Eigen::VectorXd& values,
                        double cutoff = 4, double spacing = 0.01);

}  // namespace bio
