#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/parameters/parameters.h"
#include "bio/simulation/simulate.h"

namespace bio {

/// Derivatives of one quantity along a motion; rows = times, columns = parameters.
using SensitivityMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A simulated motion and its derivatives with respect to parameters [unit of the quantity per unit
/// of θ]. Behind the columns of the parameters stand those of the nodes of an external force, if
/// there are any (ExternalNodes).
struct SensitivityTrajectory {
  Trajectory motion;
  std::vector<SensitivityMatrix> q;            ///< dq/dθ of each free coordinate
  std::vector<SensitivityMatrix> qDot;         ///< dq̇/dθ of each free coordinate
  std::vector<SensitivityMatrix> fibreLength;  ///< of each muscle; empty unless asked for
  /// dw/dθ of each muscle's thickness w = ℓ0 sin α0, the same at all times; empty unless asked for.
  std::vector<Eigen::RowVectorXd> thickness;
  std::vector<SensitivityMatrix> activation;   ///< of each muscle; empty unless asked for
  std::vector<SensitivityMatrix> tendonForce;  ///< of each muscle; empty unless asked for
  /// Sensitivities of the reaction at each free coordinate; empty unless it is prescribed and they
  /// are asked for.
  std::vector<SensitivityMatrix> reaction;
  double wallSeconds = 0;  ///< of the sensitivities; motion.wallSeconds is that of the motion
};

/// Nodes of external forces on some coordinates, linear between them and 0 outside, as for
/// SimulationOptions::externalForce. Their values [N·m] or [N] are parameters: first those of the
/// first coordinate at all times, then those of the second, …
struct ExternalNodes {
  std::vector<int> coordinates;  ///< indices in the skeleton, free or prescribed
  std::vector<double> times;     ///< [s] strictly rising; empty, or at least two
  Eigen::Index count() const {
    return static_cast<Eigen::Index>(coordinates.size() * times.size());
  }
};

/// ∂(external force on one coordinate)/∂θ of a parameter that shapes SimulationOptions::
/// externalForce: linear within each interval between times, where it may jump, and 0 outside them.
struct ExternalSlope {
  Eigen::Index column = 0;      ///< of θ among the parameters wanted
  int coordinate = 0;           ///< index in the skeleton, free or prescribed
  std::vector<double> times;    ///< [s] strictly rising, at least two
  Eigen::VectorXd first, last;  ///< where each interval begins and ends [force per unit of θ]
  double at(double t) const;
};

struct SensitivityOptions {
  SimulationOptions simulation;  ///< integrator: variational or variationalLeft
  bool muscles = false;          ///< also fibre lengths, activations and tendon forces
  bool reactions = false;        ///< also reactions, for which those of the muscles are needed
  ExternalNodes externalNodes = {};
  std::vector<ExternalSlope> externalSlopes = {};
};

/// Simulates the trial and differentiates the discrete motion exactly with respect to parameters.
///
/// A step solves r(z', z, θ) = 0 for z' = (q', ℓ'_i), so by the implicit function theorem
///     dz'/dθ = −J⁻¹(∂r/∂z·dz/dθ + ∂r/∂θ)
/// with the arrow-shaped J of simulate(); all parameters are the columns of one matrix. Activations
/// follow their exact recursion, row by row of the trial. The initial state depends on θ as well:
/// fibres are in static equilibrium at the excitation of the first row. If a step is split at a
/// switch of a path, the time of the switch is one more unknown with the equation D(q(t)) = 0.
/// Discrete decisions are held fixed: which steps are halved, on which side a path passes. See
/// docs/theory/sensitivity.md.
///
/// The derivatives are those of the computed motion: central differences of complete simulations
/// agree to within their own accuracy. At kinks (a fibre exactly between shortening and
/// lengthening, a path at lift-off) the derivative is that of one side.
///
/// @param system      compiled from setting.model
/// @param setting  catalogue.at(…) or catalogue.nominal()
/// @param wanted   indices of the catalogue's parameters, columns of the result in this order
/// @param trial    as recorded; setting.mapping turns it into excitations
/// @throws std::invalid_argument for another integrator, and what simulate() throws;
///   NoStaticEquilibrium
SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& system,
                                                const ParameterCatalogue& catalogue,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<std::size_t>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options);

/// Sensitivities along directions in any elementary numbers of the setting, one column each.
SensitivityTrajectory simulateWithSensitivities(const MusculoskeletalSystem& system,
                                                const ParameterCatalogue::Setting& setting,
                                                const std::vector<ParameterDirection>& wanted,
                                                const ExcitationSignal& trial,
                                                const SensitivityOptions& options);

/// Only the motion, from the same inputs.
Trajectory simulateSetting(const MusculoskeletalSystem& system,
                           const ParameterCatalogue::Setting& setting,
                           const ExcitationSignal& trial, const SimulationOptions& options);

/// The initial state of a setting: its coordinates and speeds, with the fibres in static
/// equilibrium. @throws NoStaticEquilibrium
SystemState startOf(const MusculoskeletalSystem& system, const ParameterCatalogue::Setting& setting,
                    const ExcitationSignal& driven, double time);

/// Names of the system's muscles, in order.
std::vector<std::string> muscleNames(const MusculoskeletalSystem& system);

}  // namespace bio
