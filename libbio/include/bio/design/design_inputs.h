#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/trial.h"
#include "info/design/bounded_profiles.h"

namespace bio {

/// Muscles that share one excitation, as when a person or a stimulator drives them together.
struct MuscleGroup {
  std::string name;
  std::vector<std::string> muscles;
};

/// Limits of the inputs and of the motion of a designed experiment.
struct DesignLimits {
  double torque = 10;              ///< largest |torque| [N·m] (or force [N]) ≥ 0; 0: none
  double torqueRate = 50;          ///< largest change [N·m/s] > 0
  double leastExcitation = 0.01;   ///< of a driven group, 0 to 1
  double largestExcitation = 0.5;  ///< of a driven group, 0 to 1
  double excitationRate = 2;       ///< largest change of an excitation [1/s] > 0
  double lower, upper;             ///< of the observed coordinate [rad] or [m]
  double speed = 8.7;              ///< largest speed of the coordinate [rad/s] or [m/s]
  /// The range is respected, to first order, even if the parameters of interest are off by this
  /// many prior standard deviations (given, else default) ≥ 0. Without this margin the most
  /// informative motion is an unstable equilibrium, where a tiny parameter error changes the motion
  /// completely.
  double surprise = 0.5;
};

/// The inputs that a design may change: the external torque on the observed coordinate and the
/// excitations of muscle groups, piecewise linear between knots, within limits of size and rate
/// (info::BoundedProfiles). Everything else of the trial is kept.
class DesignInputs {
 public:
  /// @param coordinate coordinate on which the torque acts, free in `arm`
  /// @param measuredTimes rows of every designed trial [s]
  /// @throws std::invalid_argument for a limit out of range, an unknown muscle, a muscle in two
  ///   groups, no input, knots that are not > 0 apart
  DesignInputs(const MusculoskeletalSystem& arm, Trial trial, std::string coordinate,
               double startTime, double duration, const DesignLimits& limits,
               std::vector<MuscleGroup> groups, double knotInterval,
               std::vector<double> measuredTimes);

  /// The torque, if there is one, then the groups.
  const info::BoundedProfiles& profiles() const { return profiles_; }
  bool hasTorque() const { return limits_.torque > 0; }
  const std::vector<MuscleGroup>& groups() const { return groups_; }
  const DesignLimits& limits() const { return limits_; }
  const std::vector<double>& measuredTimes() const { return measuredTimes_; }

  /// The trial with the inputs of these coefficients; empty: with its own inputs, on the same rows.
  Trial at(const Eigen::VectorXd& x) const;
  /// Coefficients closest to the trial's own inputs.
  Eigen::VectorXd own() const;
  /// Random initial coefficients about those for a search: random walks along the knots, with sizes
  /// from an eighth of the limits to the full limits. Reproducible for equal arguments.
  Eigen::VectorXd random(std::uint64_t seed, std::uint64_t which) const;
  /// The external torque on the coordinate in every row; zeros if the trial has none.
  Eigen::VectorXd torqueOf(const Trial& trial) const;
  /// Largest changes [unit/s] between rows: of the torque, and of the groups' excitations.
  double largestTorqueRate(const Trial& trial) const;
  double largestExcitationRate(const Trial& trial) const;

 private:
  std::string coordinate_;
  DesignLimits limits_;
  std::vector<MuscleGroup> groups_;
  std::vector<std::vector<Eigen::Index>> columns_;  ///< of the groups' muscles in the trial
  std::vector<double> measuredTimes_;
  info::BoundedProfiles profiles_;
  Trial trial_;  ///< rows: its own times, the knots, the measured times
};

}  // namespace bio
