#pragma once

// Not public.

#include <Eigen/Dense>
#include <vector>

#include "bio/discovery/sensor_law.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/observable.h"

namespace bio::discover {

/// Signal of a sensor in a simulated motion, at the stamps of its samples (sensor_law.h), with
/// x the observable, x_L after the sensor's lag and t′ the time at which it was measured:
///     y = (1 + gain)·x_L(t′) + bias + drift·(t − t₀)
/// A coordinate is the cubic of Hermite between rows, and before the first row goes on with its
/// first speed; other observables are those of ObservedMotion, with a lag linear between rows, and
/// before the first row as there.
class SensedMotion {
 public:
  /// @param stamps of the samples [s] rising
  /// @param first  t₀ [s]
  /// @throws std::invalid_argument for what the system does not have (ObservedMotion)
  SensedMotion(const MusculoskeletalSystem& system, Observable what, const SensorLaw& law,
               std::vector<double> stamps, double first);

  /// Options that the sensitivities need (SensitivityOptions).
  bool needsMuscles() const { return needsMuscles_; }
  bool needsReactions() const { return needsReactions_; }

  struct Shown {
    Eigen::VectorXd values;  ///< y; NaN at times that the motion has not reached
    Eigen::VectorXd rates;   ///< (1 + gain)·ẋ_L(t′)
  };
  Shown shown(const Trajectory& motion) const;

  /// NaN at times that the motion has not reached.
  struct Slopes {
    /// (1 + gain)·∂x_L/∂θ: samples × all columns of the sensitivities
    SensitivityMatrix gamma;
    Eigen::VectorXd value;  ///< x_L
    Eigen::VectorXd inLag;  ///< ∂y/∂lag
  };
  Slopes slopes(const SensitivityTrajectory& motion) const;

  const SensorLaw& law() const { return law_; }
  /// t − t₀ of the samples
  Eigen::VectorXd since() const;
  /// t′ of a sample
  double measuredAt(Eigen::Index sample) const {
    return law_.measuredAt(stamps_[static_cast<std::size_t>(sample)], first_);
  }
  Eigen::Index size() const { return static_cast<Eigen::Index>(stamps_.size()); }

 private:
  /// x_L, ẋ_L and ∂x_L/∂lag at t′ of the samples.
  struct Sensed {
    Eigen::VectorXd value, rate, inLag;
  };
  Sensed sensed(const Trajectory& motion) const;
  Sensed sensedCoordinate(const Trajectory& motion) const;
  Sensed sensedLate(const Trajectory& motion) const;
  /// t′ + shift of the samples; those outside the motion are its ends.
  Eigen::VectorXd timesWithin(const Trajectory& motion, double shift) const;
  /// The observable without lag.
  Eigen::VectorXd valuesAt(const Trajectory& motion, const Eigen::VectorXd& times) const;

  const MusculoskeletalSystem* system_;
  Observable what_;
  SensorLaw law_;
  std::vector<double> stamps_;
  double first_;
  int coordinate_ = -1;  ///< in the skeleton; −1: another observable
  bool needsMuscles_, needsReactions_;
};

}  // namespace bio::discover
