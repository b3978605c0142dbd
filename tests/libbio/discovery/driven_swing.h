#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "libbio/discovery/free_swing.h"

/// A pendulum with a motor, which differs from its command.
namespace bio::discover {

inline constexpr double swingMass = 1, swingViscosity = 0.15;

/// A point mass on a rod, with a damper that the model has.
inline Model drivenPendulum() {
  Model model = freePendulum(swingMass);
  SpringGeneralizedForce damper{"bearing", "swing"};
  damper.viscosity = swingViscosity;
  model.springForces.push_back(damper);
  return model;
}

inline SystemOptions drivenOptions() {
  return {{{"swing"}, {}}, {}, {}};
}

/// What a motor makes of its command.
struct MotorError {
  double gain = 1, delay = 0, lag = 0, limit = std::numeric_limits<double>::infinity();
};

/// Three waves, and the torque that a motor makes of them, which lags behind.
class Motor {
 public:
  Motor(unsigned seed, const MotorError& error) : error_(error) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (auto& wave : waves_) {
      for (double& number : wave) number = unit(generator);
    }
    torque_ = command(0);
  }
  double command(double t) const {
    double sum = 0;
    for (const auto& [frequency, phase, size] : waves_)
      sum += (0.6 + size) * std::sin(2 * std::numbers::pi * ((0.4 + 1.2 * frequency) * t + phase));
    return sum;
  }
  /// Torque at t, from t − h.
  double torque(double t, double h) {
    const double wanted = command(std::max(0.0, t - error_.delay));
    torque_ = error_.lag > 0 ? wanted + (torque_ - wanted) * std::exp(-h / error_.lag) : wanted;
    return error_.gain * std::clamp(torque_, -error_.limit, error_.limit);
  }

 private:
  MotorError error_;
  std::array<std::array<double, 3>, 3> waves_{};
  double torque_ = 0;
};

/// The motion by small steps of the leapfrog, with 0.1 degrees of noise; the command in a column,
/// of a torque or, with an optimal force, of the control of an actuator "motor".
inline Trial drivenSwing(unsigned seed, const MotorError& error, double seconds = 3,
                         double optimalForce = 0) {
  constexpr int perRow = 200;
  constexpr double every = 0.02, h = every / perRow;
  const auto rows = static_cast<Eigen::Index>(std::lround(seconds / every)) + 1;
  Trial trial;
  trial.file = "driven" + std::to_string(seed) + ".csv";
  trial.times = Eigen::VectorXd::LinSpaced(rows, 0, seconds);
  trial.excitations.resize(rows, 0);
  trial.measured.push_back({ofCoordinate("swing"), trial.times, Eigen::VectorXd(rows)});
  AppliedForce motor{"swing", Eigen::VectorXd(rows)};
  std::mt19937 generator(seed + 1000);
  std::normal_distribution<double> noise(0, 0.1 * std::acos(-1) / 180);
  Motor drive(seed, error);
  double q = 0, w = 0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double start = every * static_cast<double>(k);
    trial.measured.front().values[k] = q + noise(generator);
    motor.values[k] = drive.command(start);
    for (int i = 0; i < perRow; ++i) {
      const double half = q + h / 2 * w;
      const double torque = drive.torque(start + (i + 0.5) * h, h);
      w += h * (torque - swingViscosity * w - swingMass * 9.81 * rodLength * std::sin(half)) /
           (swingMass * rodLength * rodLength);
      q = half + h / 2 * w;
    }
  }
  if (optimalForce != 0) {
    motor.actuator = "motor";
    motor.optimalForce = optimalForce;
    motor.control = motor.values / optimalForce;
  }
  trial.applied.push_back(std::move(motor));
  return trial;
}

}  // namespace bio::discover
