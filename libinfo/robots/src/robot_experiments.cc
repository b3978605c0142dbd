#include "robots/robot_experiments.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "info/estimation/monte_carlo.h"
#include "robots/instances.h"

namespace info {
namespace {

template <class S>
Predictor predictorOf(const S& system, const CartMotion& motion) {
  if (!(motion.timeStep > 0 && std::isfinite(motion.timeStep)))
    throw std::invalid_argument(
        fmt::format("cart motion: time step {} s must be > 0", motion.timeStep));
  if (motion.stepsPerSample < 1 || motion.acceleration.size() <= motion.stepsPerSample)
    throw std::invalid_argument("cart motion: there must be at least one sample");
  using Map = Rk4<S>;
  std::vector<InputOf<Map>> inputs;
  for (double u : motion.acceleration) inputs.push_back(InputOf<Map>(u));
  return makePredictor(Map{system, motion.timeStep},
                       Experiment<Map>{StateOf<Map>::Zero(), inputs,
                                       stepsEvery(motion.stepsPerSample, motion.stepsPerSample,
                                                  motion.acceleration.size() - 1)});
}

}  // namespace

CartMotion cosineMotion(double amplitude, double period, double duration, double sampleRate,
                        std::size_t stepsPerSample) {
  for (double value : {amplitude, period, duration, sampleRate})
    if (!(value > 0 && std::isfinite(value)))
      throw std::invalid_argument(
          fmt::format("cart motion: amplitude {} m, period {} s, duration {} s and sample rate {} "
                      "Hz must be > 0",
                      amplitude, period, duration, sampleRate));
  if (stepsPerSample < 1) throw std::invalid_argument("cart motion: steps per sample must be ≥ 1");
  CartMotion motion{{}, 1 / (sampleRate * static_cast<double>(stepsPerSample)), stepsPerSample};
  const double omega = 2 * std::numbers::pi / period;
  const auto steps = static_cast<std::size_t>(std::lround(duration / motion.timeStep));
  for (std::size_t k = 0; k <= steps; ++k)
    motion.acceleration.push_back(amplitude * omega * omega *
                                  std::cos(omega * static_cast<double>(k) * motion.timeStep));
  return motion;
}

CartMotion doublePendulumStart() {
  return cosineMotion(0.05, 5, 5, 30, 2);
}

CartMotion suspendedMassStart() {
  return cosineMotion(0.0476, 5, 5, 100, 1);
}

CartMotion suspendedMassLively() {
  return cosineMotion(0.1, 1.2, 5, 100, 1);
}

Eigen::MatrixXd simulateMeasurement(const PlannedExperiment& experiment, std::uint64_t seed) {
  const Eigen::MatrixXd exact = experiment.predictor.outputs(experiment.truth);
  RandomStream random(seed, 0);
  return exact + drawNoise(experiment.covariance, exact.cols(), random);
}

PlannedExperiment doublePendulumExperiment(const CartMotion& motion,
                                           DoublePendulumUnknowns unknowns, double damping) {
  if (!(damping >= 0 && std::isfinite(damping)))
    throw std::invalid_argument(fmt::format("damping {} kg m²/s must be ≥ 0", damping));
  const OutputCovariance covariance(Eigen::Vector2d(1.12e-4, 4.79e-4).asDiagonal().toDenseMatrix());
  if (unknowns == DoublePendulumUnknowns::mass1AndDamping)
    return {predictorOf(CartDoublePendulum<DoublePendulumUnknowns::mass1AndDamping>{}, motion),
            covariance,
            {{.name = "m1", .unit = "kg", .start = 0.085, .lower = 1e-3},
             {.name = "c", .unit = "g m²/s", .start = 0.5}},
            Eigen::Vector2d(0.085, 0.5)};
  CartDoublePendulum<DoublePendulumUnknowns::bothMasses> system;
  system.damping = damping;
  return {predictorOf(system, motion),
          covariance,
          {{.name = "m1", .unit = "kg", .start = 0.085, .lower = 1e-3},
           {.name = "m2", .unit = "kg", .start = 0.0847, .lower = 1e-3}},
          Eigen::Vector2d(0.085, 0.0847)};
}

PlannedExperiment suspendedMassExperiment(const CartMotion& motion) {
  return {predictorOf(SuspendedMass{}, motion),
          OutputCovariance(Eigen::MatrixXd::Constant(1, 1, 500.0 / 33044)),
          {{.name = "m", .unit = "kg", .start = 0.10},
           {.name = "l", .unit = "m", .start = 0.60, .lower = 0.01}},
          Eigen::Vector2d(0.12, 0.50)};
}

}  // namespace info
