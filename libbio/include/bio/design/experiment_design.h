#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "bio/design/input_search.h"
#include "bio/observation/channel_information.h"
#include "bio/observation/observed_motion.h"
#include "info/design/trajectory_search.h"
#include "info/information/optimality.h"

namespace bio {

/// The measurement and the parameters of interest.
struct DesignQuestion {
  std::vector<ChannelCandidate> observed;  ///< at least one, each with its noise
  double period = 0.01;                    ///< between measurements [s] > 0
  std::vector<std::size_t> parameters;     ///< parameters of interest, indices of the catalogue
  std::vector<std::size_t> nuisance = {};  ///< nuisance parameters, indices of the catalogue
  /// Prior standard deviation of each parameter of interest, then of each nuisance parameter;
  /// infinite: no prior.
  Eigen::VectorXd priorSd;
  info::Optimality criterion = info::Optimality::e;  ///< a, d or e, of scaled parameters
};

/// Extremes of a motion, and those with parameters off by DesignLimits::robustness [rad] or [m].
struct MotionRange : MotionExtremes {
  double surprisedLowest = 0, surprisedHighest = 0;
};

/// One experiment and its information.
struct DesignedExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of DesignInputs::profiles(); empty: the trial's
  /// With what is predicted as measured: the coordinates that are free to move, then all other
  /// observables.
  Trial trial;
  Trajectory motion;
  Eigen::VectorXd measuredTimes;  ///< [s]
  Eigen::MatrixXd measured;       ///< times × observables, as predicted, in unitOf()
  Eigen::MatrixXd gamma;        ///< Γ, observable after observable: rows × (parameters, nuisance)
  Eigen::MatrixXd information;  ///< of the data and the priors [1/(unit·unit)]
  Eigen::VectorXd bound;  ///< standard deviations [unit] with all others unknown, too; ∞: unbounded
  std::vector<MotionRange> ranges;  ///< of DesignLimits::coordinates
};

/// Result of a search.
struct DesignResult : DesignSearchRecord {
  DesignedExperiment before, after;
  double costBefore = 0;  ///< φ of the baseline trial
};

/// Finds the excitations and the external torques that are most informative about parameters.
///
/// Inputs are piecewise linear between knots within limits of size and rate
/// (info::BoundedProfiles). The cost is a criterion of the information about the parameters of
/// interest, with the nuisance parameters unknown (Schur complement), each in units of its default
/// prior standard deviation,
///     E: −ln λ_min    A: ln tr I⁻¹    D: −ln det I
/// plus a penalty for leaving a coordinate's range and for too high speeds; a motion that does
/// not reach the end counts as impossible. I = Σ_o Γ_oᵀΓ_o/σ_o² over the observables o, as
/// localSensitivity() has it. The search is InputSearch, and ends with info::DesignSearch along
/// gradients. The result is the best experiment tried that respects every limit.
class ExperimentDesign {
 public:
  /// @param trial the baseline trial: excitations, duration, the course of prescribed coordinates.
  ///   Muscles in no group keep their excitations.
  /// @param setting    the model's values, catalogue.nominal() or another; made of the same model
  ///   as `system`
  /// @param groups muscle groups whose excitations are designed; may be empty
  /// @param simulation integrator vi, vi-left or vi-adaptive; start time, duration, step
  /// @throws std::invalid_argument what ObservedMotion and DesignInputs throw, a number out of
  ///   range, nothing observed or twice the same, no parameter
  ExperimentDesign(const MusculoskeletalSystem& system, const ParameterCatalogue& catalogue,
                   ParameterCatalogue::Setting setting, const Trial& trial,
                   const SimulationOptions& simulation, DesignQuestion question,
                   DesignLimits limits, std::vector<MuscleGroup> groups, double knotInterval = 0.3);

  const DesignInputs& inputs() const { return inputs_; }
  const MusculoskeletalSystem& system() const { return *system_; }
  const DesignQuestion& question() const { return question_; }

  /// The baseline trial. @throws NoStaticEquilibrium; std::runtime_error if it does not reach the
  /// end
  DesignedExperiment before() const;
  /// The experiment with the inputs of these coefficients. @throws as before()
  DesignedExperiment at(const Eigen::VectorXd& x) const;
  /// Whether a motion respects range and speed, and the inputs their limits.
  bool keepsLimits(const DesignedExperiment& experiment) const;

  /// Deviations of the observables from what is predicted, to first order, if the parameters of
  /// interest are off by DesignLimits::robustness prior standard deviations: measured times ×
  /// observables, in unitOf().
  Eigen::MatrixXd allowanceAt(const DesignedExperiment& experiment) const;
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
  Eigen::MatrixXd inNoise(const Eigen::MatrixXd& gamma) const;
  Eigen::MatrixXd scaledInformation(const Eigen::MatrixXd& gamma) const;
  double penalty(const SensitivityTrajectory& s, double price) const;
  /// How far what has these derivatives is from where it was expected.
  template <class Rows>
  Eigen::VectorXd allowanceOf(const Rows& slopes) const;
  std::vector<MotionRange> rangesOf(const SensitivityTrajectory& s) const;
  bool keepsRanges(const std::vector<MotionRange>& ranges) const;
  class Runs;

  const MusculoskeletalSystem* system_;
  const ParameterCatalogue* catalogue_;
  ParameterCatalogue::Setting setting_;
  SimulationOptions simulation_;
  DesignQuestion question_;
  std::vector<std::size_t> wanted_;  ///< parameters, then nuisance
  Eigen::VectorXd scale_;
  DesignInputs inputs_;
  ObservedMotion observed_;
  std::vector<Observable> predicted_;  ///< free coordinates, then the other observables
};

/// The flexors and the extensors of a coordinate, by the sign of the moment arm at its initial
/// value, with the other coordinates at their defaults; without muscles that do not cross it.
std::vector<MuscleGroup> flexorsAndExtensors(const MusculoskeletalSystem& system,
                                             const Eigen::VectorXd& q, int coordinate = 0);

}  // namespace bio
