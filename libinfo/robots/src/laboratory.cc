#include "robots/laboratory.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "info/dynamics/integrate.h"
#include "info/dynamics/sensitivity.h"
#include "info/estimation/monte_carlo.h"
#include "robots/laboratory_plants.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kFine = 8;  // steps of the plant per time step of the motion
constexpr double kAngleRange = std::numbers::pi / 2, kForceRange = 3;

void check(const LaboratoryEffects& e) {
  const auto rule = [](bool holds, const char* what, double value, const char* unit,
                       const char* text) {
    if (!holds)
      throw std::domain_error(fmt::format("{}: {} {}, must be {}", what, value, unit, text));
  };
  rule(std::abs(e.outOfPlane) < std::numbers::pi / 2, "angle out of the plane", e.outOfPlane, "rad",
       "between −π/2 and π/2");
  const auto size = [&](const char* what, double value, const char* unit) {
    rule(value >= 0 && std::isfinite(value), what, value, unit, "≥ 0 and finite");
  };
  size("dry friction", e.dryFriction, "N m");
  size("control lag", e.controlLag, "s");
  size("control noise", e.controlNoise, "m/s²");
  rule(std::abs(e.sensorCurvature) < 1.0 / 3, "sensor curvature", e.sensorCurvature, "",
       "between −1/3 and 1/3, where the reading still rises");
  size("sensor step", e.sensorStep, "rad or N");
}

// The plant's outputs at the samples, read with noise.
template <class Plant>
MatrixXd measure(const Plant& plant, const StateOf<Plant>& x0, const CartMotion& motion,
                 const Vector2d& truth, const LaboratoryEffects& effects,
                 const OutputCovariance& covariance, double range, std::uint64_t seed) {
  using Map = Rk4<Plant>;
  std::vector<InputOf<Map>> inputs;
  for (double u : laboratoryAcceleration(motion, effects, seed, kFine))
    inputs.push_back(InputOf<Map>(u));
  const auto run = simulate(Map{plant, motion.timeStep / kFine}, x0, inputs, truth);
  const std::size_t every = kFine * motion.stepsPerSample;
  const Index samples = static_cast<Index>((inputs.size() - 1) / every);
  RandomStream random(seed, 0);
  const MatrixXd noise = drawNoise(covariance, samples, random);
  MatrixXd read(covariance.outputs(), samples);
  for (Index s = 0; s < samples; ++s) {
    const std::size_t k = every * static_cast<std::size_t>(s + 1);
    if (k >= run.x.size() || !run.x[k].allFinite())
      throw std::domain_error("laboratory: the plant's motion does not stay finite");
    const VectorXd y = plant.g(run.x[k], inputs[k], truth);
    for (Index i = 0; i < y.size(); ++i)
      read(i, s) = sensorReading(y[i], noise(i, s), range, effects);
  }
  return read;
}

}  // namespace

LaboratoryEffects usualDoublePendulumEffects() {
  return {.outOfPlane = 3 * std::numbers::pi / 180,
          .dryFriction = 1e-5,
          .controlLag = 0.002,
          .controlNoise = 0.05,
          .sensorCurvature = 0.01,
          .sensorStep = 1e-3};
}

LaboratoryEffects usualSuspendedMassEffects() {
  return {.outOfPlane = 3 * std::numbers::pi / 180,
          .dryFriction = 1e-4,
          .controlLag = 0.002,
          .controlNoise = 0.05,
          .sensorCurvature = 0.01,
          .sensorStep = 3.0 / 1024};
}

std::vector<double> laboratoryAcceleration(const CartMotion& motion,
                                           const LaboratoryEffects& effects, std::uint64_t seed,
                                           int fine) {
  check(effects);
  if (fine < 1)
    throw std::invalid_argument(fmt::format("values per time step: {}, must be ≥ 1", fine));
  const double h = motion.timeStep / fine, lag = effects.controlLag;
  const double kept = lag > 0 ? std::exp(-h / lag) : 0;
  RandomStream random(seed, 1);
  std::vector<double> out;
  double behind = 0;
  for (std::size_t k = 0; k < motion.acceleration.size(); ++k) {
    const double noise = effects.controlNoise > 0 ? effects.controlNoise * random.normal() : 0;
    const double now = motion.acceleration[k];
    const bool last = k + 1 == motion.acceleration.size();
    const double slope = last ? 0 : (motion.acceleration[k + 1] - now) / motion.timeStep;
    for (int i = 0; i < (last ? 1 : fine); ++i) {
      const double command = now + slope * h * i;
      out.push_back((lag > 0 ? behind : command) + noise);
      // exact for a command that is linear over h
      behind = command + slope * (h - lag) + (behind - command + slope * lag) * kept;
    }
  }
  return out;
}

double sensorReading(double y, double noise, double range, const LaboratoryEffects& effects) {
  const double share = y / range;
  const double read = y * (1 + effects.sensorCurvature * share * share) + noise;
  return effects.sensorStep > 0 ? effects.sensorStep * std::round(read / effects.sensorStep) : read;
}

MatrixXd measureDoublePendulum(const CartMotion& motion, const Vector2d& truth,
                               const LaboratoryEffects& effects, std::uint64_t seed) {
  TiltingDoublePendulum plant;
  plant.dryFriction = effects.dryFriction;
  Vector<double, 6> x0 = Vector<double, 6>::Zero();
  x0[2] = effects.outOfPlane;
  return measure(plant, x0, motion, truth, effects, doublePendulumExperiment(motion).covariance,
                 kAngleRange, seed);
}

MatrixXd measureSuspendedMass(const CartMotion& motion, const Vector2d& truth,
                              const LaboratoryEffects& effects, std::uint64_t seed) {
  SphericalSuspendedMass plant;
  plant.dryFriction = effects.dryFriction;
  Vector<double, 6> x0 = Vector<double, 6>::Zero();
  x0[1] = std::sin(effects.outOfPlane);
  x0[2] = -std::cos(effects.outOfPlane);
  return measure(plant, x0, motion, truth, effects, suspendedMassExperiment(motion).covariance,
                 kForceRange, seed);
}

}  // namespace info
