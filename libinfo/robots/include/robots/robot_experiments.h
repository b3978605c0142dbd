#pragma once

#include <cstdint>
#include <vector>

#include "info/estimation/least_squares.h"
#include "robots/cart_double_pendulum.h"

/// The two robots of chapter 4 of Wilson's thesis as experiments: from an acceleration of the cart,
/// a predictor with the noise of the sensor and the names of the parameters. Motions start at rest,
/// hanging down.
namespace info {

/// A simulated experiment.
struct PlannedExperiment {
  Predictor predictor;
  OutputCovariance covariance;
  std::vector<Parameter> parameters;  ///< start: the initial values of the thesis
  Eigen::VectorXd truth;              ///< the true values of the simulated data
};

/// Accelerations u_0 … u_K of the cart, linear in between.
struct CartMotion {
  std::vector<double> acceleration;  ///< [m/s²]
  double timeStep;                   ///< Δt of the integrator [s] > 0
  std::size_t stepsPerSample;        ///< number of steps per sample, ≥ 1
};

/// The kind of initial motion used in the thesis, x(t) = amplitude·(1 − cos 2πt/period), by its
/// acceleration.
/// @throws std::invalid_argument unless all are > 0 and finite
CartMotion cosineMotion(double amplitude, double period, double duration, double sampleRate,
                        std::size_t stepsPerSample);

/// x(t) = 0.05(1 − cos 2πt/5) m for 5 s, 150 samples at 30 Hz, Δt = 1/60 s (relative error of the
/// bound below 2e-4).
CartMotion doublePendulumStart();

/// x(t) = 0.0476(1 − cos 2πt/5) m for 5 s, 500 samples at 100 Hz.
CartMotion suspendedMassStart();

/// x(t) = 0.1(1 − cos 2πt/1.2) m, sampled likewise: a fast motion for which both parameters
/// are well determined (κ = 7.9, smallest tension 0.31 N).
CartMotion suspendedMassLively();

/// Cart and double pendulum: absolute angles of both links with the variances of (4.4), RK4;
/// θ = (m1 [kg], c [g m²/s]) at (0.085, 0.5) of (4.5), or θ = (m1, m2) [kg] with c held at
/// `damping`.
/// @param damping c [kg m²/s] ≥ 0, used if both masses are unknown
PlannedExperiment doublePendulumExperiment(
    const CartMotion& motion,
    DoublePendulumUnknowns unknowns = DoublePendulumUnknowns::mass1AndDamping,
    double damping = 5e-4);

/// Cart and double pendulum as in chapter 5: the cart's positions x_0 … x_K [m], variational step,
/// samples at a multiple of the step; θ = (m1 [kg], c [10e-3 kg m²/s]) at (0.085, 0.05).
PlannedExperiment doublePendulumStepExperiment(const std::vector<double>& position, double timeStep,
                                               std::size_t stepsPerSample);

/// Cart and mass on a string: the string's force, θ = (m [kg], ℓ [m]), start (0.10, 0.60), truth
/// (0.12, 0.50), RK4. The noise, which the thesis does not state, is chosen to reproduce λ₁ =
/// 3.18e6 of Table 4.5 for 500 samples: σ² = 500/33044 N².
PlannedExperiment suspendedMassExperiment(const CartMotion& motion);

/// One recording of the experiment: y(truth) with noise from RandomStream(seed, 0).
Eigen::MatrixXd simulateMeasurement(const PlannedExperiment& experiment, std::uint64_t seed);

}  // namespace info
