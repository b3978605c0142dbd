#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bio/design/design_inputs.h"
#include "bio/design/experiment_design.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "info/discovery/judgement/distinction.h"

namespace bio::discover {

/// The two effects to discriminate, and the measurement of the coordinate.
struct SeparationQuestion {
  std::string first, second;  ///< ids of the catalogue
  /// Assumed amplitudes in their units; 0: the prior standard deviation of the amplitude, with the
  /// sign that the effect may have.
  double firstSize = 0, secondSize = 0;
  double start = 0;      ///< of the coordinate [rad] or [m]
  double noise = 0.009;  ///< standard deviation of a measurement [rad] or [m] > 0
  double period = 0.01;  ///< between measurements [s] > 0
};

/// Sets the assumed amplitudes of effects by id or long name, in their units.
/// @throws std::invalid_argument for the name of another effect, or a size of 0
SeparationQuestion withSizes(SeparationQuestion question,
                             const std::map<std::string, double>& sizes);

/// One experiment and its expected log Bayes factors.
struct SeparatingExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of DesignInputs::profiles(); empty: the trial's own
  Trial trial;             ///< with the base model's motion as measured
  Eigen::VectorXd base, first, second;  ///< the coordinate at the measured times [rad] or [m]
  info::discover::Distinction tells;
  double lowest = 0, highest = 0, fastest = 0;  ///< over all three motions, at the measured times
  bool keepsLimits = false;
};

struct SeparatingResult {
  SeparatingExperiment before, after;
  bool improved = false;     ///< `after` differs from `before` and respects the limits
  bool stopped = false;      ///< stopped by the callback
  int runs = 0;              ///< experiments that were simulated
  int impossible = 0;        ///< experiments that did not reach the end
  std::vector<double> nats;  ///< of each new best experiment that respects the limits
  std::vector<int> foundAt;  ///< run at which it was found
};

/// Finds the excitations and the external torque that best discriminate two effects: they maximise
/// the smaller of both expected log Bayes factors (info::discover::distinction), with every
/// parameter of the base model uncertain by its default prior. The search starts with random inputs
/// and continues with info::evolve(). All motions, without an effect and with either, respect the
/// coordinate's range and speed.
class SeparatingDesign {
 public:
  /// @param trial the baseline trial: excitations, torque, experimental conditions
  /// @throws std::invalid_argument for an unknown effect or one that the model already has, a size
  ///   outside its bounds, what DesignInputs and MusculoskeletalProblem throw
  SeparatingDesign(const Model& model, const SystemOptions& arm, const std::string& coordinate,
                   const Trial& trial, const MusculoskeletalProblemOptions& options,
                   SeparationQuestion question, const DesignLimits& limits,
                   std::vector<bio::MuscleGroup> groups, double knotInterval = 0.3);

  const DesignInputs& inputs() const { return inputs_; }
  const std::string& coordinate() const { return coordinate_; }
  const SeparationQuestion& question() const { return question_; }
  /// The catalogue entries.
  const info::discover::Candidate& first() const { return candidates_[0]; }
  const info::discover::Candidate& second() const { return candidates_[1]; }
  const std::string& unitOfFirst() const { return units_[0]; }
  const std::string& unitOfSecond() const { return units_[1]; }

  /// @throws std::domain_error where one of the motions does not reach the end
  SeparatingExperiment before() const { return at({}); }
  SeparatingExperiment at(const Eigen::VectorXd& x) const;

  /// `settings.iterations` is not used.
  /// @throws std::domain_error if the trial itself cannot be simulated with and without the effects
  SeparatingResult search(const DesignSearchSettings& settings) const;

 private:
  MusculoskeletalProblem planned(const Trial& trial) const;
  double price(const SeparatingExperiment& e) const;

  Model model_;
  SystemOptions arm_;
  std::string coordinate_;
  MusculoskeletalProblemOptions options_;
  SeparationQuestion question_;
  DesignInputs inputs_;
  info::discover::PresentEffect effects_[2];
  info::discover::Candidate candidates_[2];
  std::string units_[2];
};

/// The experiment as a trial for replay and discover: excitations of every muscle, the torque, the
/// experimental conditions, and the base model's motion at the measured times.
Table separatingTable(const SeparatingDesign& design, const SeparatingExperiment& experiment);

}  // namespace bio::discover
