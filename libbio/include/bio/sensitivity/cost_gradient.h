#pragma once

#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "bio/sensitivity/coupled_sensitivity.h"

namespace bio {

/// A scalar cost J of a motion, with its slopes in coordinates and speeds at the motion's rows;
/// rows = free coordinates, columns = rows of the motion.
struct CostOfMotion {
  double value = 0;      ///< J
  Eigen::MatrixXd q;     ///< ∂J/∂q
  Eigen::MatrixXd qDot;  ///< ∂J/∂q̇ at fixed q
};
using MotionCost = std::function<CostOfMotion(const Trajectory&)>;

/// A cost of a simulated motion and its derivatives [1 per unit].
struct CostGradient {
  Trajectory motion;
  double cost = 0;                  ///< J; NaN if the motion ends before it can be told
  Eigen::VectorXd gradient;         ///< dJ/dθ of the parameters wanted
  Eigen::VectorXd startCoordinate;  ///< in the coordinates at the start; prescribed ones: 0
  Eigen::VectorXd startSpeed;       ///< in the speeds at the start; prescribed ones: 0
  Eigen::MatrixXd excitation;       ///< in u_i at the rows of the driven trial; muscles × rows
  double wallSeconds = 0;  ///< of cost and gradient; motion.wallSeconds is that of the motion
};

/// Simulates the trial and differentiates a cost of the discrete motion exactly, in any number of
/// parameters for the price of a few simulations.
///
/// A step solves r(z′, z, θ) = 0; with λ = dJ/dz, the slopes of J in a row's own state included,
/// one sweep from the last step to the first gives
///     μ = r_z′⁻ᵀ λ′,   λ = ∂J/∂z − r_zᵀ μ,   dJ/dθ = − Σ r_θᵀ μ + (∂z_0/∂θ)ᵀ λ_0
/// where r_θᵀμ is summed up by muscle, path and segment, and sorted into parameters at the end. z_0
/// is the start with the fibres in static equilibrium. Exact where simulateWithSensitivities() is,
/// for the same parameters, and at the same kinks one-sided. See docs/theory/sensitivity.md.
///
/// @param system, catalogue, setting, wanted, trial  as for simulateWithSensitivities
/// @param cost  smooth; called once with the motion. If the value is not finite, all derivatives
///   are NaN.
/// @throws std::invalid_argument for an integrator other than the variational ones, slopes of
///   another size than the motion's, and what simulate() throws; NoStaticEquilibrium
CostGradient simulateWithGradient(const MusculoskeletalSystem& system,
                                  const ParameterCatalogue& catalogue,
                                  const ParameterCatalogue::Setting& setting,
                                  const std::vector<std::size_t>& wanted,
                                  const ExcitationSignal& trial, const SimulationOptions& options,
                                  const MotionCost& cost);

/// The gradient along directions in any elementary numbers of the setting.
CostGradient simulateWithGradient(const MusculoskeletalSystem& system,
                                  const ParameterCatalogue::Setting& setting,
                                  const std::vector<ParameterDirection>& wanted,
                                  const ExcitationSignal& trial, const SimulationOptions& options,
                                  const MotionCost& cost);

}  // namespace bio
