#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <string>
#include <vector>

#include "bio/simulation/musculoskeletal_system.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"
#include "info/design/bounded_profiles.h"

namespace bio {

/// Muscles that share one excitation, as when a person or a stimulator drives them together.
struct MuscleGroup {
  std::string name;
  std::vector<std::string> muscles;
};

/// Limits of a free coordinate in a designed experiment.
struct CoordinateLimits {
  std::string coordinate;
  double lower, upper;  ///< [rad] or [m]
  double speed = 8.7;   ///< largest |speed| [rad/s] or [m/s] > 0
  double torque = 10;   ///< largest |torque| [N·m] or |force| [N] from outside ≥ 0; 0: none
};

/// Limits of the inputs and of the motion of a designed experiment.
struct DesignLimits {
  std::vector<CoordinateLimits> coordinates;
  double torqueRate = 50;          ///< largest change [N·m/s] or [N/s] > 0
  double leastExcitation = 0.01;   ///< of a driven group, 0 to 1
  double largestExcitation = 0.5;  ///< of a driven group, 0 to 1
  double excitationRate = 2;       ///< largest change of an excitation [1/s] > 0
  /// Ranges are respected, to first order, even if the parameters of interest are off by this
  /// many prior standard deviations (given, else default) ≥ 0. Without this margin the most
  /// informative motion is an unstable equilibrium, where a tiny parameter error changes the motion
  /// completely.
  double robustness = 0.5;
};

/// The inputs that a design may change: torques from outside on free coordinates, and excitations
/// of muscle groups, piecewise linear between knots, within limits of size and rate
/// (info::BoundedProfiles). Everything else of the trial is kept.
class DesignInputs {
 public:
  /// @param limits         of coordinates that are free in `system`
  /// @param measuredTimes  rows of every designed trial [s]
  /// @throws std::invalid_argument for a limit out of range, a coordinate that is not free or is
  ///   named twice, an unknown muscle, a muscle in two groups, no input, knots that are not > 0
  ///   apart
  DesignInputs(const MusculoskeletalSystem& system, Trial trial, double startTime, double duration,
               DesignLimits limits, std::vector<MuscleGroup> groups, double knotInterval,
               std::vector<double> measuredTimes);

  /// The torques, then the groups.
  const info::BoundedProfiles& profiles() const { return profiles_; }
  /// The coordinates with a torque.
  const std::vector<CoordinateLimits>& torques() const { return torques_; }
  const std::vector<MuscleGroup>& groups() const { return groups_; }
  const DesignLimits& limits() const { return limits_; }
  const std::vector<double>& measuredTimes() const { return measuredTimes_; }
  /// The observables at the measured times, with the values of a plan: times × observables.
  std::vector<MeasuredChannel> measured(const std::vector<Observable>& observables,
                                        const Eigen::MatrixXd& values) const;

  /// The trial with the inputs of these coefficients; empty: with its own inputs, on the same rows.
  Trial at(const Eigen::VectorXd& x) const;
  /// Coefficients closest to the trial's own inputs.
  Eigen::VectorXd own() const;
  /// Random initial coefficients about those for a search: random walks along the knots, with sizes
  /// from an eighth of the limits to the full limits. Reproducible for equal arguments.
  Eigen::VectorXd random(std::uint64_t seed, std::uint64_t which) const;
  /// The torque on a coordinate in every row; zeros if the trial has none.
  Eigen::VectorXd torqueOf(const Trial& trial, const std::string& coordinate) const;
  double largestTorque(const Trial& trial, const std::string& coordinate) const {
    return torqueOf(trial, coordinate).cwiseAbs().maxCoeff();
  }
  /// Largest changes [unit/s] between rows: of a torque, and of the groups' excitations.
  double largestTorqueRate(const Trial& trial, const std::string& coordinate) const;
  double largestExcitationRate(const Trial& trial) const;

 private:
  DesignLimits limits_;
  std::vector<CoordinateLimits> torques_;
  std::vector<MuscleGroup> groups_;
  std::vector<std::vector<Eigen::Index>> columns_;  ///< of the groups' muscles in the trial
  std::vector<double> measuredTimes_;
  info::BoundedProfiles profiles_;
  Trial trial_;  ///< rows: its own times, the knots, the measured times
};

/// Extremes of the planned motion of a free coordinate.
struct MotionExtremes {
  double lowest = 0, highest = 0;  ///< [rad] or [m]
  double fastest = 0;              ///< |speed| [rad/s] or [m/s]
};

/// A planned experiment as a trial that can be replayed: excitations, forces from outside, the
/// course of prescribed coordinates, experimental conditions, and what is predicted of the
/// channels that will be measured; in radians and metres.
/// @param trial  with the predictions as measured
Table plannedTable(const MusculoskeletalSystem& system, const Trial& trial);

}  // namespace bio
