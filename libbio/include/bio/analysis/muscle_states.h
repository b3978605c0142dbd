#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bio {

/// Rates, forces and equilibrium of a muscle in one state, by the law of its class.
struct MuscleState {
  std::string className;     ///< as the file has it
  double fibreVelocity;      ///< ℓ̇ [m/s]
  double tendonForce;        ///< F_T [N]
  double staticFibreLength;  ///< ℓ at rest at this activation and path length [m]; NaN: none
  double staticTendonForce;  ///< F_T there [N]; NaN: none
};

/// Evaluates the muscle laws for the rows of a .csv file with a header. Columns: `class`,
/// `max_isometric_force` [N], `optimal_fiber_length` [m], `tendon_slack_length` [m], `pennation`
/// [rad], `max_contraction_velocity` [ℓ0/s] (not used by Schutte's class), `activation`,
/// `fiber_length` [m] (may be empty with a rigid tendon), `path_length` [m], `path_speed` [m/s]
/// (used with a rigid tendon only; may be left out: 0).
///
/// `class` is an OpenSim class: Schutte1993Muscle_Deprecated, Thelen2003Muscle,
/// Millard2012EquilibriumMuscle, DeGrooteFregly2016Muscle, at the class's defaults. A suffix
/// changes some of them: `_rigid` (ignore_tendon_compliance), `_undamped` (Millard with
/// fiber_damping 0),
/// `_gait` (Thelen with FmaxTendonStrain 0.033, KshapeActive 0.5, KshapePassive 4, Af 0.3,
/// Flen 1.8) and `_mobl` (Millard with the curves of the MoBL-ARMS models). A column with the name
/// of an OpenSim property of the class (`fiber_damping`, `Flen`) sets that property where its cell
/// is not empty; columns of results are not read.
/// @throws FileError for a missing column, a cell that is no number, an unknown class or column, or
/// a
///   value that breaks a rule of the class
std::vector<MuscleState> muscleStates(const std::filesystem::path& file);

}  // namespace bio
