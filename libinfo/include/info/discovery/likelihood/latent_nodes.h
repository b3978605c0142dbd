#pragma once

#include <Eigen/Dense>
#include <vector>

#include "info/discovery/likelihood/discovery_problem.h"

namespace info::discover {

/// Correlation over an interval Δ [s] of an Ornstein–Uhlenbeck process with time constant ℓ after a
/// first-order lag τ:
///     κ(Δ) = (ℓ e^{−Δ/ℓ} − τ e^{−Δ/τ})/(ℓ − τ),   e^{−Δ/ℓ} for τ = 0
double latentCorrelation(double interval, double time, double lag);

/// Prior covariance of a latent force over σ_d²: (L Lᵀ)_ab = (G Gᵀ)_ab κ(|t_a − t_b|) for the nodes
/// a = (time, axis).
/// @param scale G: nodes × channels
/// @param time  ℓ [s] > 0
/// @param lag   τ [s] ≥ 0
Eigen::MatrixXd latentCovariance(const std::vector<Node>& nodes, const Eigen::MatrixXd& scale,
                                 double time, double lag);

/// Times of a trial's nodes on any of the axes [s].
std::vector<double> nodeTimes(const DiscoveryProblem& data, int trial);

/// The rows of one axis, from values at all nodes of a trial, one per row.
Eigen::MatrixXd onAxis(const Eigen::MatrixXd& values, std::size_t axis, std::size_t numAxes);

/// @throws std::invalid_argument if the nodes of a trial are not those of every axis in turn, all
///   at the same rising times
void requireOrdered(const DiscoveryProblem& data, int trial);

}  // namespace info::discover
