#pragma once

#include <cstdint>
#include <vector>

#include "info/estimation/least_squares.h"
#include "robots/cart_double_pendulum.h"

/// The two robots of chapter 4 as experiments on their estimators: an acceleration of the cart in,
/// a predictor with the sensor's noise and the parameters' names out. Motions start at rest,
/// hanging down.
namespace info {

/// An experiment that has not been done: what its data would say can be computed all the same.
struct PlannedExperiment {
  Predictor predictor;
  OutputCovariance covariance;
  std::vector<Parameter> parameters;  ///< start: the values the thesis starts from
  Eigen::VectorXd truth;              ///< the values its data are simulated with
};

/// Accelerations u_0 … u_K of the cart, linear in between.
struct CartMotion {
  std::vector<double> acceleration;  ///< [m/s²]
  double timeStep;                   ///< Δt of the integrator [s] > 0
  std::size_t stepsPerSample;        ///< samples after every so many steps, ≥ 1
};

/// The thesis's kind of start, x(t) = amplitude·(1 − cos 2πt/period), by its acceleration.
/// @throws std::invalid_argument unless all are > 0 and finite
CartMotion cosineMotion(double amplitude, double period, double duration, double sampleRate,
                        std::size_t stepsPerSample);

/// x(t) = 0.05(1 − cos 2πt/5) m for 5 s, 150 samples at 30 Hz, Δt = 1/60 s (the bound is within
/// 2e-4 of itself at Δt → 0).
CartMotion doublePendulumStart();

/// x(t) = 0.0476(1 − cos 2πt/5) m for 5 s, 500 samples at 100 Hz.
CartMotion suspendedMassStart();

/// x(t) = 0.1(1 − cos 2πt/1.2) m, likewise: shakes the mass so that both parameters show (κ = 7.9,
/// least tension 0.31 N).
CartMotion suspendedMassLively();

/// Cart and double pendulum: absolute angles of both links with the variances of (4.4), RK4;
/// θ = (m1 [kg], c [1e-3 kg m²/s]) at (0.085, 0.5) of (4.5), or θ = (m1, m2) [kg] with c held at
/// `damping`.
/// @param damping c [kg m²/s] ≥ 0, used where both masses are unknown
PlannedExperiment doublePendulumExperiment(
    const CartMotion& motion,
    DoublePendulumUnknowns unknowns = DoublePendulumUnknowns::mass1AndDamping,
    double damping = 5e-4);

/// The same robot in chapter 5's terms: the cart's positions x_0 … x_K [m], the variational step,
/// samples after every so many steps; θ = (m1 [kg], c [10e-3 kg m²/s]) at (0.085, 0.05).
PlannedExperiment doublePendulumStepExperiment(const std::vector<double>& position, double timeStep,
                                               std::size_t stepsPerSample);

/// Cart and mass on a string: the string's force, θ = (m [kg], ℓ [m]), start (0.10, 0.60), truth
/// (0.12, 0.50), RK4. The noise, which the thesis does not print, has the deviation that gives
/// Table 4.5's λ₁ = 3.18e6 for 500 samples: σ² = 500/33044 N².
PlannedExperiment suspendedMassExperiment(const CartMotion& motion);

/// One recording of the experiment: y(truth) with noise from RandomStream(seed, 0).
Eigen::MatrixXd simulateMeasurement(const PlannedExperiment& experiment, std::uint64_t seed);

}  // namespace info
