#include "robots/compliant_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "info/dynamics/integrate.h"

namespace info {
namespace {

void positive(const char* what, double value, const char* unit) {
  if (!(value > 0 && std::isfinite(value)))
    throw std::domain_error(fmt::format("{}: {} {}, must be > 0 and finite", what, value, unit));
}

}  // namespace

CompliantArm::CompliantArm(const SystemOptions& arm, const LoadCell& cell,
                           const ArmDisturbance& disturbance, const Vector<double, 2>& load,
                           std::uint64_t seed, std::uint64_t stream)
    : arm_(arm),
      cell_(cell),
      disturbance_(disturbance),
      load_(load),
      sensorNoise_(seed, 2 * stream),
      vibration_(seed, 2 * stream + 1),
      reference_(arm.start),
      state_(arm.start, 0, 0, 0) {
  positive("arm, natural frequency", arm.naturalFrequency, "rad/s");
  positive("arm, damping ratio", arm.dampingRatio, "");
  positive("arm, largest acceleration", arm.maxAcceleration, "m/s²");
  positive("arm, largest speed", arm.maxSpeed, "m/s");
  positive("load, mass", load[0], "kg");
  positive("load, length", load[1], "m");
  positive("load cell, standard deviation", cell.sd, "N");
  positive("disturbance, hold", disturbance.hold, "s");
  if (!(cell.capacity > 0))
    throw std::domain_error(fmt::format("load cell, capacity: {} N, must be > 0", cell.capacity));
  if (!(disturbance.acceleration >= 0 && std::isfinite(disturbance.acceleration)))
    throw std::domain_error(
        fmt::format("disturbance: {} m/s², must be ≥ 0 and finite", disturbance.acceleration));
  if (!std::isfinite(arm.start))
    throw std::domain_error(fmt::format("arm, start: {} m, must be finite", arm.start));
  holdTicks_ = std::max(1L, std::lround(disturbance.hold / tick));
}

double CompliantArm::servo() const {
  const double w = arm_.naturalFrequency;
  return std::clamp(
      w * w * (reference_ - state_[0]) + 2 * arm_.dampingRatio * w * (referenceSpeed_ - state_[2]),
      -arm_.maxAcceleration, arm_.maxAcceleration);
}

void CompliantArm::advance(double command) {
  if (ticks_ % holdTicks_ == 0) shake_ = disturbance_.acceleration * vibration_.normal();
  const double u = std::clamp(command, -arm_.maxAcceleration, arm_.maxAcceleration);
  const double before = referenceSpeed_, gripper = servo();
  // the load feels the gripper and the vibration; the gripper itself does not move by the latter
  const Vector<double, 1> top(gripper + shake_);
  const Vector<double, 4> moved = Rk4<SuspendedMass>{system_, tick}.step(state_, top, top, load_);
  state_[0] += tick * state_[2] + 0.5 * tick * tick * gripper;
  state_[2] += tick * gripper;
  state_[1] = moved[1];
  state_[3] = moved[3];
  referenceSpeed_ = std::clamp(before + tick * u, -arm_.maxSpeed, arm_.maxSpeed);
  reference_ += 0.5 * tick * (before + referenceSpeed_);
  ++ticks_;
}

double CompliantArm::tension() const {
  return system_.g(state_, Vector<double, 1>(servo() + shake_), load_)[0];
}

SystemReading CompliantArm::read() {
  const double noisy = tension() + cell_.sd * sensorNoise_.normal();
  return {time(),    reference_, state_[0],
          state_[2], servo(),    std::clamp(noisy, 0.0, cell_.capacity)};
}

}  // namespace info
