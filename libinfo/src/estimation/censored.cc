#include "info/estimation/censored.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace info {

void checkSensor(const ClippedSensor& sensor) {
  if (!(sensor.sd > 0 && std::isfinite(sensor.sd)))
    throw std::domain_error(
        fmt::format("sensor, standard deviation: {}, must be > 0 and finite", sensor.sd));
  if (!(sensor.lower < sensor.upper))
    throw std::domain_error(fmt::format("sensor, limits: {} to {}, must satisfy lower < upper",
                                        sensor.lower, sensor.upper));
}

SampleCost minusLogNormal(double t) {
  // The ratio φ/Φ; below −8 by Laplace's continued fraction of Mills' ratio
  double ratio, value;
  if (t > -8) {
    const double phi = std::exp(-0.5 * t * t) / std::sqrt(2 * std::numbers::pi);
    const double below = 0.5 * std::erfc(-t / std::numbers::sqrt2);
    ratio = phi / below;
    value = t > 5 ? -std::log1p(-0.5 * std::erfc(t / std::numbers::sqrt2)) : -std::log(below);
  } else {
    double fraction = -t;
    for (int k = 40; k >= 1; --k) fraction = -t + k / fraction;
    ratio = fraction;
    value = 0.5 * t * t + 0.5 * std::log(2 * std::numbers::pi) + std::log(fraction);
  }
  // d²(−ln Φ)/dt² = ratio (t + ratio); t + ratio cancels in the tail
  double sum = t + ratio;
  if (t <= -8) {
    double fraction = -t;
    for (int k = 40; k >= 2; --k) fraction = -t + k / fraction;
    sum = 1 / fraction;
  }
  return {value, -ratio, ratio * sum};
}

SampleCost sampleCost(const ClippedSensor& sensor, double reading, double predicted) {
  checkSensor(sensor);
  if (!std::isfinite(reading))
    throw std::domain_error(fmt::format("sensor, reading: {}, must be finite", reading));
  const double s = sensor.sd;
  const auto atLimit = [&](double t, double sign) {
    const SampleCost c = minusLogNormal(t);
    return SampleCost{c.value, sign * c.slope / s, c.curvature / (s * s)};
  };
  if (reading >= sensor.upper) return atLimit((predicted - sensor.upper) / s, 1);
  if (reading <= sensor.lower) return atLimit((sensor.lower - predicted) / s, -1);
  const double t = (predicted - reading) / s;
  return {0.5 * t * t, t / s, 1 / (s * s)};
}

}  // namespace info
