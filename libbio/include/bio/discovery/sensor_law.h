#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/tables/trial.h"

namespace bio::discover {

/// The relation between the coordinate q and the measurement with time stamp t:
///     y(t) = (1 + gain)·q_L(t₀ + (1 + rate)(t − t₀) − clock) + bias + drift·(t − t₀)
/// t₀ the trial's first row, and q_L the coordinate after a first-order lag,
///     lag·q̇_L = q − q_L,   q_L(t₀) = q(t₀)
struct SensorLaw {
  double bias = 0;   ///< [rad] or [m]
  double gain = 0;   ///< [1]
  double clock = 0;  ///< [s]
  double rate = 0;   ///< [1] > −1, relative slowness of its clock
  double lag = 0;    ///< time constant [s] ≥ 0
  double drift = 0;  ///< [rad/s] or [m/s]

  /// Whether the sensor is free of errors.
  bool isTrue() const {
    return bias == 0 && gain == 0 && clock == 0 && rate == 0 && lag == 0 && drift == 0;
  }
  /// Time at which the coordinate had the value with time stamp t, apart from the lag [s].
  double measuredAt(double t, double first) const {
    return first + (1 + rate) * (t - first) - clock;
  }
};

/// A course after a first-order lag, with its derivative with respect to the lag. The course is
/// linear between its times, for which the result is exact.
struct Lagged {
  Eigen::MatrixXd value;       ///< q_L: courses × times
  Eigen::MatrixXd speed;       ///< q̇_L
  Eigen::MatrixXd inLag;       ///< ∂q_L/∂lag
  Eigen::MatrixXd inLagSpeed;  ///< ∂q̇_L/∂lag
};
/// @param lag  τ [s] ≥ 0; 0: the course itself, with its speeds, and ∂q_L/∂τ = −q̇
Lagged lagged(const std::vector<double>& times, const Eigen::Ref<const Eigen::MatrixXd>& q,
              const Eigen::Ref<const Eigen::MatrixXd>& qDot, double lag);

/// The trial as a sensor without errors would have measured it; samples whose time lies outside the
/// trial are dropped. A lag is undone with the rate of the smoothed course (smoothed_motion.h).
Trial asTrueSensor(Trial trial, const Observable& what, const SensorLaw& sensor);

}  // namespace bio::discover
