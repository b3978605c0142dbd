#pragma once

#include <cstdint>

#include "robots/robot_experiments.h"

/// The robots of chapter 4 as a laboratory has them (laboratory_plants.h), with a drive and a
/// sensor that err. The source names the effects (end of section 4.4.4) and prints no sizes; the
/// usual ones here are chosen so that estimates err about as much as its own.
namespace info {

/// What a laboratory has and the model has not, by size; 0 each: the model itself.
struct LaboratoryEffects {
  double outOfPlane = 0;       ///< angle out of the plane at the start, at rest [rad], |·| < π/2
  double dryFriction = 0;      ///< moment of each joint, or of the string's pivot [N m] ≥ 0
  double controlLag = 0;       ///< time constant of the cart's speed behind the commanded [s] ≥ 0
  double controlNoise = 0;     ///< deviation of the cart's acceleration, drawn anew for every time
                               ///< step [m/s²] ≥ 0
  double sensorCurvature = 0;  ///< b: y(1 + b (y/range)²) is read, range π/2 rad or 3 N; |b| < 1/3
  double sensorStep = 0;       ///< what is read is a multiple of this [rad or N] ≥ 0
};

LaboratoryEffects usualDoublePendulumEffects();
LaboratoryEffects usualSuspendedMassEffects();

/// What the sensor reads of the cart with the double pendulum, with the noise of (4.4) from
/// RandomStream(seed, 0): absolute angles [rad], outputs × samples.
/// @param truth (m1 [kg], c [1e-3 kg m²/s])
/// @throws std::domain_error naming an effect out of its range
Eigen::MatrixXd measureDoublePendulum(const CartMotion& motion, const Eigen::Vector2d& truth,
                                      const LaboratoryEffects& effects, std::uint64_t seed);

/// What the load cell reads of the cart with the mass on a string, likewise, with the noise of
/// suspendedMassExperiment [N].
/// @param truth (m [kg], ℓ [m])
Eigen::MatrixXd measureSuspendedMass(const CartMotion& motion, const Eigen::Vector2d& truth,
                                     const LaboratoryEffects& effects, std::uint64_t seed);

/// The cart's acceleration as the laboratory gives it: the commanded a(t), linear between its
/// times, through
///     lag·ȧ_c = a − a_c,   a_c(0) = 0
/// which is a speed that lags, exactly on the grid; plus the noise of RandomStream(seed, 1).
/// @param fine values per time step, ≥ 1; one more at the end
std::vector<double> laboratoryAcceleration(const CartMotion& motion,
                                           const LaboratoryEffects& effects, std::uint64_t seed,
                                           int fine);

/// What a sensor makes of y: curvature, noise, then steps.
double sensorReading(double y, double noise, double range, const LaboratoryEffects& effects);

}  // namespace info
