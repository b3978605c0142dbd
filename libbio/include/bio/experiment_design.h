#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bio/coupled_sensitivity.h"
#include "bio/design_inputs.h"
#include "bio/table_file.h"
#include "bio/trial.h"
#include "info/optimality.h"
#include "info/trajectory_search.h"

namespace bio {

/// What is measured, and what is asked.
struct DesignQuestion {
  std::string coordinate = "elbow_flexion";           ///< measured, and pushed by the torque
  double noise = 0.5 * 3.14159265358979323846 / 180;  ///< standard deviation [rad] or [m] > 0
  double period = 0.01;                               ///< between measurements [s] > 0
  std::vector<std::size_t> parameters;                ///< of the catalogue: to be known better
  std::vector<std::size_t> nuisance = {};             ///< of the catalogue: unknown as well
  /// What is known beforehand: standard deviation of each parameter, then each nuisance
  /// parameter; infinite: nothing.
  Eigen::VectorXd priorDeviation;
  info::Optimality criterion = info::Optimality::e;  ///< a, d or e, of scaled parameters
};

/// One experiment and what it tells.
struct DesignedExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of ExperimentDesign::profiles(); empty: the trial's
  ExcitationSignal excitation;
  ExternalForce torque;  ///< empty: none
  Trajectory motion;
  Eigen::VectorXd measuredTimes;  ///< [s]
  Eigen::VectorXd measured;       ///< the coordinate at them, as predicted [rad] or [m]
  Eigen::MatrixXd gamma;          ///< Γ at them: times × (parameters, nuisance)
  Eigen::MatrixXd information;    ///< of the data and what was known before, [1/(unit·unit)]
  Eigen::VectorXd
      bound;  ///< standard deviations [unit], the others being unknown too; ∞: unbounded
  double lowest = 0, highest = 0;                    ///< of the coordinate [rad] or [m]
  double surprisedLowest = 0, surprisedHighest = 0;  ///< with parameters off by their deviations
  double fastest = 0;                                ///< |speed| [rad/s] or [m/s]
  double largestTorque = 0, largestTorqueRate = 0, largestExcitationRate = 0;  ///< of the tables
};

struct DesignSearchSettings {
  int candidates = 100;   ///< random inputs tried first ≥ 0
  int generations = 100;  ///< of the evolution from the best of them ≥ 0
  int iterations = 10;    ///< of the search along gradients at the end ≥ 0
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Called with the share done, from any thread, one call at a time; false: stop, keep the best.
  std::function<bool(double)> progress = {};
};

/// What a search did.
struct DesignResult {
  DesignedExperiment before, after;
  bool improved = false;      ///< after is another experiment than before, and keeps the limits
  bool stopped = false;       ///< the callback said so
  int runs = 0;               ///< simulations with sensitivities
  int impossible = 0;         ///< of them that did not reach the end
  double costBefore = 0;      ///< φ of the trial as it is
  std::vector<double> costs;  ///< φ of the best experiment that keeps the limits, as it was found
  std::vector<int> foundAt;   ///< run at which it was
};

/// Seeks the excitations and the torque from outside that tell most about parameters.
///
/// Inputs are straight lines between knots within their limits and rates (info::BoundedProfiles);
/// the cost is a criterion of the information about the parameters, the nuisance ones being unknown
/// too (Schur complement), each in units of its default deviation,
///     E: −ln λ_min    A: ln tr I⁻¹    D: −ln det I
/// plus a price on leaving the coordinate's range and on too high speeds; a motion that does not
/// reach the end counts as impossible. Random inputs first, then info::evolve() from the best, then
/// info::DesignSearch along gradients. Of all experiments that were tried, the best one that keeps
/// every limit is the result. Why not by projections: docs/decisions/014.
class ExperimentDesign {
 public:
  /// @param trial      the experiment that there is: its excitations, duration and start. Muscles
  ///   in no group keep them.
  /// @param setting    the model's values, catalogue.nominal() or another; made of the same model
  ///   as `arm`
  /// @param groups     muscles to be driven anew; may be empty
  /// @param simulation integrator vi or vi-left; start time, duration, step
  /// @throws std::invalid_argument for a coordinate that is not free, a limit or a number out of
  ///   range, an unknown muscle, a muscle in two groups, no input at all, no parameter
  ExperimentDesign(const Arm& arm, const ParameterCatalogue& catalogue,
                   ParameterCatalogue::Setting setting, const Trial& trial,
                   const SimulationOptions& simulation, DesignQuestion question,
                   DesignLimits limits, std::vector<MuscleGroup> groups, double knotInterval = 0.3);

  /// The torque, if there is one, then the groups.
  const info::BoundedProfiles& profiles() const { return inputs_.profiles(); }
  const Arm& arm() const { return *arm_; }
  bool hasTorque() const { return inputs_.hasTorque(); }
  const std::vector<MuscleGroup>& groups() const { return inputs_.groups(); }
  const DesignQuestion& question() const { return question_; }
  const DesignLimits& limits() const { return inputs_.limits(); }

  /// The trial as it is. @throws NoStaticEquilibrium; std::runtime_error if it does not reach the
  /// end
  DesignedExperiment before() const;
  /// With inputs of these coefficients. @throws as before()
  DesignedExperiment at(const Eigen::VectorXd& x) const;
  /// Whether a motion keeps to range and speed, and the inputs to their limits.
  bool keepsLimits(const DesignedExperiment& experiment) const;

  /// How far the coordinate may be from what is expected at the measured times when the parameters
  /// asked for are off by DesignLimits::surprise of their deviations, to first order [rad] or [m].
  Eigen::VectorXd surpriseAt(const DesignedExperiment& experiment) const;
  /// Bound on the first parameter from the measurements up to each measured time; NaN: unbounded.
  Eigen::VectorXd boundOverTime(const DesignedExperiment& experiment) const;

  /// @throws std::runtime_error if the trial itself does not reach the end
  DesignResult search(const DesignSearchSettings& settings) const;

  /// φ(I) of the information about (parameters, nuisance) in units of their default deviations,
  /// and its gradient. @throws std::domain_error where I has no inverse
  info::InformationCost cost(const Eigen::MatrixXd& scaledInformation,
                             double repeatedTolerance) const;
  /// Default deviations: the units of cost().
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  SensitivityTrajectory simulateTrial(const Trial& trial) const;
  Eigen::MatrixXd gammaOf(const SensitivityTrajectory& s) const;
  Eigen::MatrixXd scaledInformation(const Eigen::MatrixXd& gamma) const;
  DesignedExperiment describe(Eigen::VectorXd x) const;
  double penalty(const SensitivityTrajectory& s, double price) const;
  Eigen::VectorXd surpriseOf(const SensitivityTrajectory& s) const;
  bool keepsRange(double lowest, double highest, double fastest) const;

  const Arm* arm_;
  const ParameterCatalogue* catalogue_;
  ParameterCatalogue::Setting setting_;
  SimulationOptions simulation_;
  DesignQuestion question_;
  int coordinate_;
  std::vector<std::size_t> wanted_;  ///< parameters, then nuisance
  Eigen::VectorXd scale_;
  DesignInputs inputs_;
};

/// Muscles that bend the coordinate and muscles that stretch it, at its start value and the
/// model's other defaults: by the sign of the moment arm.
std::vector<MuscleGroup> flexorsAndExtensors(const Arm& arm, const Eigen::VectorXd& q,
                                             int coordinate = 0);

/// The experiment as a trial that can be replayed: excitations of every muscle, the torque
/// (`<coordinate>.torque`) if there is one, and the predicted coordinate in radians where it is to
/// be measured.
Table designTable(const Arm& arm, const DesignedExperiment& experiment,
                  const std::string& coordinate);

}  // namespace bio
