#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

#include "bio/arm.h"
#include "bio/trial.h"
#include "info/bounded_profiles.h"

namespace bio {

/// Muscles that are driven together, as a person or a stimulator drives them.
struct MuscleGroup {
  std::string name;
  std::vector<std::string> muscles;
};

/// What an experimenter may do, and what the arm must not.
struct DesignLimits {
  double torque = 10;              ///< largest |torque| [N·m] (or force [N]) ≥ 0; 0: none
  double torqueRate = 50;          ///< largest change [N·m/s] > 0
  double leastExcitation = 0.01;   ///< of a driven group, 0 to 1
  double largestExcitation = 0.5;  ///< of a driven group, 0 to 1
  double excitationRate = 2;       ///< largest change of an excitation [1/s] > 0
  double lower, upper;             ///< of the observed coordinate [rad] or [m]
  double speed = 8.7;              ///< largest speed of the coordinate [rad/s] or [m/s]
  /// The range is kept, to first order, also when the parameters asked for are off by so many of
  /// their deviations (what is known beforehand, else the catalogue's) ≥ 0. Without it, the most
  /// informative motion is an arm balanced where it is about to fall: a parameter that is off by a
  /// hair sends it anywhere.
  double surprise = 0.5;
};

/// What may be changed of a trial: the torque from outside on the observed coordinate, and the
/// excitations of groups of muscles, straight lines between knots within their limits and rates
/// (info::BoundedProfiles). Everything else of the trial stays.
class DesignInputs {
 public:
  /// @param coordinate     that is pushed, free in `arm`
  /// @param measuredTimes  are rows of every trial, too [s]
  /// @throws std::invalid_argument for a limit out of range, an unknown muscle, a muscle in two
  ///   groups, nothing to change, knots that are not > 0 apart
  DesignInputs(const Arm& arm, Trial trial, std::string coordinate, double startTime,
               double duration, const DesignLimits& limits, std::vector<MuscleGroup> groups,
               double knotInterval, std::vector<double> measuredTimes);

  /// The torque, if there is one, then the groups.
  const info::BoundedProfiles& profiles() const { return profiles_; }
  bool hasTorque() const { return limits_.torque > 0; }
  const std::vector<MuscleGroup>& groups() const { return groups_; }
  const DesignLimits& limits() const { return limits_; }
  const std::vector<double>& measuredTimes() const { return measuredTimes_; }

  /// The trial with inputs of these coefficients; empty: with its own, on the same rows.
  Trial at(const Eigen::VectorXd& x) const;
  /// Coefficients that come nearest to the trial's own inputs.
  Eigen::VectorXd own() const;
  /// Random coefficients about those, for a search to begin with: walks along the knots of sizes
  /// from an eighth of what is allowed to all of it. The same arguments give the same.
  Eigen::VectorXd random(std::uint64_t seed, std::uint64_t which) const;
  /// A trial's torque from outside on the coordinate, in every row; zeros if it has none.
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
  Trial trial_;  ///< on all rows: its own, the knots, the measured times
};

}  // namespace bio
