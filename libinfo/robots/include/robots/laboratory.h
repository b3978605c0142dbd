#pragma once

#include <cstdint>

#include "robots/robot_experiments.h"

/// The robots of chapter 4 of Wilson's thesis as real plants (laboratory_plants.h), with errors of
/// drive and sensor. The source names the effects (end of section 4.4.4) without their sizes; the
/// usual sizes below give errors of the estimates about as large as in the source.
namespace info {

/// Sizes of the effects of a laboratory that are missing in the model; all 0: the model itself.
struct LaboratoryEffects {
  double outOfPlane = 0;   ///< initial angle out of the plane, at rest [rad], |·| < π/2
  double dryFriction = 0;  ///< friction moment of each joint, or of the string's pivot [N m] ≥ 0
  double controlLag = 0;   ///< time constant of the cart's speed relative to the command [s] ≥ 0
  double controlNoise = 0;     ///< deviation of the cart's acceleration, drawn anew for every time
                               ///< step [m/s²] ≥ 0
  double sensorCurvature =
      0;  ///< b: the reading is y(1 + b (y/range)²), range π/2 rad or 3 N; |b| < 1/3
  double sensorStep = 0;  ///< quantisation step of the reading [rad or N] ≥ 0
};

LaboratoryEffects usualDoublePendulumEffects();
LaboratoryEffects usualSuspendedMassEffects();

/// Readings of the cart with the double pendulum, with the noise of (4.4) from RandomStream(seed,
/// 0): absolute angles [rad], outputs × samples.
/// @param truth (m1 [kg], c [g m²/s])
/// @throws std::domain_error naming an effect out of its range
Eigen::MatrixXd measureDoublePendulum(const CartMotion& motion, const Eigen::Vector2d& truth,
                                      const LaboratoryEffects& effects, std::uint64_t seed);

/// Readings of the load cell of the cart with the mass on a string, with the noise of
/// suspendedMassExperiment [N].
/// @param truth (m [kg], ℓ [m])
Eigen::MatrixXd measureSuspendedMass(const CartMotion& motion, const Eigen::Vector2d& truth,
                                     const LaboratoryEffects& effects, std::uint64_t seed);

/// The actual acceleration of the cart: the commanded a(t), linear between its times, through
///     lag·ȧ_c = a − a_c,   a_c(0) = 0
/// a first-order lag of the speed, exact on the grid; plus noise of RandomStream(seed, 1).
/// @param fine values per time step, ≥ 1; one more at the end
std::vector<double> laboratoryAcceleration(const CartMotion& motion,
                                           const LaboratoryEffects& effects, std::uint64_t seed,
                                           int fine);

/// The reading of y: curvature, noise, then quantisation.
double sensorReading(double y, double noise, double range, const LaboratoryEffects& effects);

}  // namespace info
