#pragma once

#include <Eigen/Dense>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bio/forces/external_force.h"
#include "bio/muscle/activation/excitation.h"
#include "bio/simulation/musculoskeletal_system.h"
#include "bio/simulation/prescribed_motion.h"

namespace bio {

/// How the coupled equations of skeleton and muscles are stepped.
enum class Integrator {
  variational,      ///< midpoint variational, forces on both ends, implicit muscles; second order
  variationalLeft,  ///< the same with forces on the left end only (Wilson's thesis); first order
  variationalAdaptive,  ///< `variational` in parts of a step, as short as their errors ask for
  rungeKutta4,          ///< classical, explicit; fourth order, stable for tiny steps only
  cvode                 ///< SUNDIALS BDF, adaptive, analytic Jacobian: the converged reference
};
/// Whether the forces of a step act on both its ends.
constexpr bool isSymmetric(Integrator integrator) {
  return integrator == Integrator::variational || integrator == Integrator::variationalAdaptive;
}
/// Whether it is one of the variational ones, which have sensitivities.
constexpr bool isVariational(Integrator integrator) {
  return isSymmetric(integrator) || integrator == Integrator::variationalLeft;
}

/// State of a system; column vectors over free coordinates and over muscles.
struct SystemState {
  Eigen::VectorXd q;            ///< [rad] or [m]
  Eigen::VectorXd qDot;         ///< [rad/s] or [m/s]
  Eigen::VectorXd activation;   ///< 0 … 1
  Eigen::VectorXd fibreLength;  ///< [m]
};

struct SimulationOptions {
  Integrator integrator = Integrator::variational;
  double startTime = 0;  ///< [s]
  double duration = 0;   ///< [s] > 0
  /// [s] > 0; cvode: interval of the output; adaptive: this and the longest part
  double step = 0.01;
  double newtonTolerance =
      1e-9;  ///< largest correction at convergence: q [rad], fibre lengths relative to ℓ0
  int maxIterations = 25;            ///< Newton iterations before a step is halved
  int maxHalvings = 8;               ///< a step may shrink to step/2^maxHalvings
  double relativeTolerance = 1e-10;  ///< cvode
  double absoluteTolerance = 1e-12;  ///< cvode
  /// Called after every output row with the time reached [s]; return false to stop.
  std::function<bool(double)> progress;
  /// External force; empty: none.
  ExternalForce externalForce = {};
  /// Motion of the system's prescribed coordinates, each of them and no other, over the whole time.
  /// Their values in the start state are not used.
  PrescribedMotion prescribed = {};
};

/// How a simulation ended. If not `completed`, the rows up to that time are kept.
enum class Outcome { completed, noSolution, unstable, stopped };

/// A simulated motion; matrices have one column per row of time.
struct Trajectory {
  std::vector<double> time;  ///< [s]
  Eigen::MatrixXd q;         ///< [rad] or [m]
  Eigen::MatrixXd qDot;      ///< [rad/s] or [m/s]
  Eigen::MatrixXd activation;
  Eigen::MatrixXd fibreLength;   ///< [m]
  Eigen::VectorXd muscleWork;    ///< done by the muscles on the skeleton since the start [J]
  Eigen::VectorXd passiveWork;   ///< done by the coordinate forces since the start [J]
  Eigen::VectorXd externalWork;  ///< done by the external force and by what moves the prescribed
                                 ///< coordinates since the start [J]
  /// Generalised forces that keep the prescribed coordinates on their course, rows = free
  /// coordinates [N·m] or [N], 0 for those that are not prescribed; empty if none is.
  Eigen::MatrixXd reaction;

  Outcome outcome = Outcome::completed;
  double failedAt = 0;  ///< [s]; the last time reached if not completed
  std::string why;      ///< one line; empty if completed
  long steps = 0;       ///< adaptive: their parts
  long newtonIterations = 0;
  long halvedSteps = 0;    ///< number of steps that were halved
  double wallSeconds = 0;  ///< time of the integration, without set-up and analysis
};

/// Thrown when a muscle has no static equilibrium at the start, or no finite length; names muscle,
/// length and activation.
class NoStaticEquilibrium : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Initial state of a simulation: q with speed 0, activation = excitation at `time` (at least the
/// activation floor), every fibre in static equilibrium.
/// @param excitation  one column per muscle of the system
/// @throws NoStaticEquilibrium, std::invalid_argument (sizes)
SystemState initialState(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                         const ExcitationSignal& excitation, double time);

/// Simulates the motion that the excitations produce.
///
/// Variational: with v = (q' − q)/h, midpoint quantities m and
/// f = −Σ F_T,i ∂ℓ_i/∂q + passive + external (at the middle time),
///     p  = M(q_m) v − (h/2)(½ vᵀ∂M v − ∂V) − F⁻,    F⁻ = (h/2) f (symmetric) or h f (left)
///     p' = M(q_m) v + (h/2)(½ vᵀ∂M v − ∂V) + F⁺,    F⁺ = (h/2) f or 0
///     (ℓ'_i − ℓ_i)/h = V(act_i, ℓ_m,i, ℓ_MT,i(q_m))
/// (section 3.2 of Wilson's thesis; (2.23) with the factor h). The muscle equation (3.4) is solved
/// for the fibre velocity in closed form, which has the same root and is better conditioned.
/// Newton's method uses the arrow structure: fibre lengths are eliminated one by one, and the Schur
/// complement in q is solved. If Newton's method fails, the step is halved; if the smallest step
/// fails, the outcome is noSolution. A step within which a path gains or loses conditional points
/// is split there, since the length jumps.
///
/// Adaptive: a step of length H is halved, and its halves again, at most maxHalvings times, until
/// the estimated error of each part is at most 1.25 rad/s³·H³ (metres for a coordinate that
/// slides): that of a smooth motion with q‴ = 15 rad/s³ in whole steps. Half the step is an eighth
/// of the error of a part and about a quarter of that of the motion. Newton's method ends where
/// what is left is below a hundredth of it, most often after one iteration. Sensitivities are those
/// of the motion at the times that its parts have.
///
/// A prescribed coordinate has its given value at the end of every step; its row of the first two
/// equations is not solved. Its reaction at a row is what the equations of motion lack there,
///     R = M q̈ + Ṁ q̇ − ½ q̇ᵀ∂M q̇ + ∂V − f,   M_ff q̈_f = (f + …)_f − M_fp q̈_p
/// with f at that row, from the given accelerations q̈_p and those of the others.
///
/// @throws std::invalid_argument sizes (the external force's too), step ≤ 0, duration ≤ 0, a
///   step below 1e-9 of the time, a prescribed coordinate without a course over the whole time
Trajectory simulate(const MusculoskeletalSystem& system, const ExcitationSignal& excitation,
                    const SystemState& start, const SimulationOptions& options);

/// Kinetic and potential energy at a state [J].
struct Energy {
  double kinetic = 0;
  double potential = 0;  ///< of gravity
};
Energy energyOf(const MusculoskeletalSystem& system, const Eigen::VectorXd& q,
                const Eigen::VectorXd& qDot);

/// E(t) − E(0) − work of muscles, passive and external forces at every row [J]: the energy error of
/// the integrator.
Eigen::VectorXd energyImbalance(const MusculoskeletalSystem& system, const Trajectory& trajectory);

/// max over time of |energyImbalance| [J].
double energyError(const MusculoskeletalSystem& system, const Trajectory& trajectory);

/// Muscle quantities along a motion; rows = muscles, columns = times.
struct MuscleReport {
  Eigen::MatrixXd tendonForce;         ///< [N]
  Eigen::MatrixXd muscleTendonLength;  ///< [m]
  Eigen::MatrixXd momentArm;           ///< −∂ℓ/∂q of coordinate `coordinate` [m]
};
/// @param trajectory  coordinates and fibre lengths, of muscles with rigid tendons also speeds and
///   activations
/// @throws std::invalid_argument where one of these is missing or of another size
MuscleReport reportMuscles(const MusculoskeletalSystem& system, const Trajectory& trajectory,
                           int coordinate = 0);

}  // namespace bio
