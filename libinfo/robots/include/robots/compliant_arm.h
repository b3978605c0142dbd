#pragma once

#include <cstdint>

#include "info/probability/random_stream.h"
#include "robots/suspended_mass.h"

namespace info {

/// A gripper that follows a reference along x through compliant joints: ẍ = ω²(r − x) + 2ζω(ṙ − ẋ),
/// limited by the motors.
struct SystemOptions {
  double naturalFrequency = 25;  ///< ω [rad/s] > 0
  double dampingRatio = 1;       ///< ζ [1] > 0
  double maxAcceleration = 7;    ///< of reference and gripper [m/s²] > 0
  double maxSpeed = 1.5;         ///< of the reference [m/s] > 0
  double start = -0.25;          ///< x at t = 0 [m], at rest
};

/// The load cell of the string: noise, then clipping to [0, capacity].
struct LoadCell {
  double sd = 0.1;        ///< σ [N] > 0
  double capacity = 2.5;  ///< [N] > 0; infinite: never clips above
};

/// Unmeasured disturbance of the string's top: white noise, piecewise constant.
struct ArmDisturbance {
  double acceleration = 0.5;  ///< standard deviation [m/s²] ≥ 0
  double hold = 0.01;         ///< [s] > 0
};

/// One line of the robot's log: its motion and the force.
struct SystemReading {
  double time;          ///< [s]
  double reference;     ///< r [m]
  double position;      ///< x [m]
  double velocity;      ///< ẋ [m/s]
  double acceleration;  ///< ẍ [m/s²]
  double force;         ///< reading of the load cell [N]
};

/// A robot arm with a mass on a string, simulated tick by tick. The load starts at rest, hanging.
/// Every random number is a function of seed, stream and tick.
class CompliantArm {
 public:
  static constexpr double tick = 1e-3;  ///< [s]

  /// @param load (m [kg], ℓ [m]), both > 0
  /// @throws std::domain_error naming quantity, value and rule
  CompliantArm(const SystemOptions& arm, const LoadCell& cell, const ArmDisturbance& disturbance,
               const Vector<double, 2>& load, std::uint64_t seed, std::uint64_t stream);

  /// The reference accelerates by `command` [m/s²] for one tick.
  void advance(double command);
  /// Reading of the load cell; draws its noise, so call it once per sample.
  SystemReading read();

  double time() const { return static_cast<double>(ticks_) * tick; }
  /// (x, φ, ẋ, φ̇), the true state.
  const Vector<double, 4>& state() const { return state_; }
  /// The force without noise and limits [N]; ≤ 0: the string is slack.
  double tension() const;

 private:
  double servo() const;

  SystemOptions arm_;
  LoadCell cell_;
  ArmDisturbance disturbance_;
  SuspendedMass system_;
  Vector<double, 2> load_;
  RandomStream sensorNoise_, vibration_;
  long ticks_ = 0, holdTicks_;
  double reference_, referenceSpeed_ = 0, shake_ = 0;
  Vector<double, 4> state_;
};

}  // namespace info
