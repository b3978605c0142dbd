#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bio/design/design_inputs.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"
#include "info/design/trajectory_search.h"
#include "info/information/optimality.h"

namespace bio {

/// The measurement and the parameters of interest.
struct DesignQuestion {
  std::string coordinate = "elbow_flexion";           ///< measured; the external torque acts on it
  double noise = 0.5 * 3.14159265358979323846 / 180;  ///< standard deviation [rad] or [m] > 0
  double period = 0.01;                               ///< between measurements [s] > 0
  std::vector<std::size_t> parameters;     ///< parameters of interest, indices of the catalogue
  std::vector<std::size_t> nuisance = {};  ///< nuisance parameters, indices of the catalogue
  /// Prior standard deviation of each parameter of interest, then of each nuisance parameter;
  /// infinite: no prior.
  Eigen::VectorXd priorSd;
  info::Optimality criterion = info::Optimality::e;  ///< a, d or e, of scaled parameters
};

/// One experiment and its information.
struct DesignedExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of ExperimentDesign::profiles(); empty: the trial's
  ExcitationSignal excitation;
  ExternalForce torque;  ///< empty: none
  Trajectory motion;
  Eigen::VectorXd measuredTimes;  ///< [s]
  Eigen::VectorXd measured;       ///< the coordinate at them, as predicted [rad] or [m]
  Eigen::MatrixXd gamma;          ///< Γ at them: times × (parameters, nuisance)
  Eigen::MatrixXd information;    ///< of the data and the priors [1/(unit·unit)]
  Eigen::VectorXd bound;  ///< standard deviations [unit] with all others unknown, too; ∞: unbounded
  double lowest = 0, highest = 0;  ///< of the coordinate [rad] or [m]
  double surprisedLowest = 0,
         surprisedHighest = 0;  ///< with parameters off by DesignLimits::surprise
  double fastest = 0;           ///< |speed| [rad/s] or [m/s]
  double largestTorque = 0, largestTorqueRate = 0, largestExcitationRate = 0;  ///< of the tables
};

struct DesignSearchSettings {
  int candidates = 100;   ///< random initial designs ≥ 0
  int generations = 100;  ///< of the evolution strategy from the best of them ≥ 0
  int iterations = 10;    ///< of the final gradient search ≥ 0
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores
  /// Called with the fraction done, from any thread, one call at a time; returning false stops the
  /// search and keeps the best.
  std::function<bool(double)> progress = {};
};

/// Result of a search.
struct DesignResult {
  DesignedExperiment before, after;
  bool improved = false;      ///< `after` differs from `before` and respects the limits
  bool stopped = false;       ///< stopped by the callback
  int runs = 0;               ///< simulations with sensitivities
  int impossible = 0;         ///< runs that did not reach the end
  double costBefore = 0;      ///< φ of the baseline trial
  std::vector<double> costs;  ///< φ of each new best experiment that respects the limits
  std::vector<int> foundAt;   ///< run at which it was found
};

/// Finds the excitations and the external torque that are most informative about parameters.
///
/// Inputs are piecewise linear between knots within limits of size and rate
/// (info::BoundedProfiles). The cost is a criterion of the information about the parameters of
/// interest, with the nuisance parameters unknown (Schur complement), each in units of its default
/// prior standard deviation,
///     E: −ln λ_min    A: ln tr I⁻¹    D: −ln det I
/// plus a penalty for leaving the coordinate's range and for too high speeds; a motion that does
/// not reach the end counts as impossible. The search starts with random inputs, continues with
/// info::evolve() from the best, and ends with info::DesignSearch along gradients. The result is
/// the best experiment tried that respects every limit.
class ExperimentDesign {
 public:
  /// @param trial the baseline trial: excitations, duration and initial state. Muscles in no group
  ///   keep their excitations.
  /// @param setting    the model's values, catalogue.nominal() or another; made of the same model
  ///   as `arm`
  /// @param groups muscle groups whose excitations are designed; may be empty
  /// @param simulation integrator vi or vi-left; start time, duration, step
  /// @throws std::invalid_argument for a coordinate that is not free, a limit or a number out of
  ///   range, an unknown muscle, a muscle in two groups, no input, no parameter
  ExperimentDesign(const MusculoskeletalSystem& arm, const ParameterCatalogue& catalogue,
                   ParameterCatalogue::Setting setting, const Trial& trial,
                   const SimulationOptions& simulation, DesignQuestion question,
                   DesignLimits limits, std::vector<MuscleGroup> groups, double knotInterval = 0.3);

  /// The torque, if there is one, then the groups.
  const info::BoundedProfiles& profiles() const { return inputs_.profiles(); }
  const MusculoskeletalSystem& arm() const { return *arm_; }
  bool hasTorque() const { return inputs_.hasTorque(); }
  const std::vector<MuscleGroup>& groups() const { return inputs_.groups(); }
  const DesignQuestion& question() const { return question_; }
  const DesignLimits& limits() const { return inputs_.limits(); }

  /// The baseline trial. @throws NoStaticEquilibrium; std::runtime_error if it does not reach the
  /// end
  DesignedExperiment before() const;
  /// The experiment with the inputs of these coefficients. @throws as before()
  DesignedExperiment at(const Eigen::VectorXd& x) const;
  /// Whether a motion respects range and speed, and the inputs their limits.
  bool keepsLimits(const DesignedExperiment& experiment) const;

  /// Deviation of the coordinate from the predicted motion at the measured times, to first order,
  /// if the parameters of interest are off by DesignLimits::surprise prior standard deviations
  /// [rad] or [m].
  Eigen::VectorXd surpriseAt(const DesignedExperiment& experiment) const;
  /// Bound on the first parameter from the measurements up to each measured time; NaN: unbounded.
  Eigen::VectorXd boundOverTime(const DesignedExperiment& experiment) const;

  /// @throws std::runtime_error if the trial itself does not reach the end
  DesignResult search(const DesignSearchSettings& settings) const;

  /// φ(I) of the information about (parameters of interest, nuisance parameters) in units of their
  /// default prior standard deviations, and its gradient. @throws std::domain_error where I has no
  /// inverse
  info::InformationCost cost(const Eigen::MatrixXd& scaledInformation,
                             double repeatedTolerance) const;
  /// Default prior standard deviations: the units of cost().
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  SensitivityTrajectory simulateTrial(const Trial& trial) const;
  Eigen::MatrixXd gammaOf(const SensitivityTrajectory& s) const;
  Eigen::MatrixXd scaledInformation(const Eigen::MatrixXd& gamma) const;
  DesignedExperiment describe(Eigen::VectorXd x) const;
  double penalty(const SensitivityTrajectory& s, double price) const;
  Eigen::VectorXd surpriseOf(const SensitivityTrajectory& s) const;
  bool keepsRange(double lowest, double highest, double fastest) const;
  class Runs;
  /// The best inputs among the trial's own and random ones about them.
  Eigen::VectorXd bestCandidate(const DesignSearchSettings& settings, Runs& runs) const;

  const MusculoskeletalSystem* arm_;
  const ParameterCatalogue* catalogue_;
  ParameterCatalogue::Setting setting_;
  SimulationOptions simulation_;
  DesignQuestion question_;
  int coordinate_;
  std::vector<std::size_t> wanted_;  ///< parameters, then nuisance
  Eigen::VectorXd scale_;
  DesignInputs inputs_;
};

/// The flexors and the extensors of the coordinate, by the sign of the moment arm at its initial
/// value, with the other coordinates at their defaults.
std::vector<MuscleGroup> flexorsAndExtensors(const MusculoskeletalSystem& arm,
                                             const Eigen::VectorXd& q, int coordinate = 0);

/// The experiment as a trial that can be replayed: excitations of every muscle, the torque
/// (`<coordinate>.torque`) if there is one, and the predicted coordinate in radians at the measured
/// times.
Table designTable(const MusculoskeletalSystem& arm, const DesignedExperiment& experiment,
                  const std::string& coordinate);

}  // namespace bio
