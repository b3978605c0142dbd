#pragma once

#include <map>
#include <string>
#include <vector>

#include "bio/design/input_search.h"
#include "bio/discovery/musculoskeletal_problem.h"
#include "bio/observation/channel_information.h"
#include "info/discovery/judgement/distinction.h"

namespace bio::discover {

/// The two effects to discriminate, and what is measured.
struct SeparationQuestion {
  std::string first, second;  ///< ids of the catalogue
  /// Assumed amplitudes in their units; 0: the prior standard deviation of the amplitude, with the
  /// sign that the effect may have.
  double firstSize = 0, secondSize = 0;
  std::map<std::string, double> start = {};  ///< of free coordinates [rad] or [m]; else default
  /// The measured channels, with their noise: all free coordinates, and anything else.
  std::vector<ChannelCandidate> observed = {};
  double period = 0.01;  ///< between measurements [s] > 0
};

/// Sets the assumed amplitudes of effects by id or long name, in their units.
/// @throws std::invalid_argument for the name of another effect, or a size of 0
SeparationQuestion withSizes(SeparationQuestion question,
                             const std::map<std::string, double>& sizes);

/// One experiment and its expected log Bayes factors.
struct SeparatingExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of DesignInputs::profiles(); empty: the trial's own
  Trial trial;             ///< with what is predicted of the base model as measured
  Eigen::MatrixXd base, first, second;  ///< measured times × observed, in unitOf()
  info::discover::Distinction tells;
  /// Extremes of DesignLimits::coordinates, over all three motions at the measured times.
  std::vector<MotionExtremes> ranges;
  bool keepsLimits = false;
};

/// Costs are minus the smaller log Bayes factor [nats].
struct SeparatingResult : DesignSearchRecord {
  SeparatingExperiment before, after;
};

/// Finds the excitations and the external torques that best discriminate two effects: they maximise
/// the smaller of both expected log Bayes factors (info::discover::distinction), with every
/// parameter of the base model uncertain by its default prior. The search is InputSearch. All
/// motions, without an effect and with either, respect the coordinates' ranges and speeds.
class SeparatingDesign {
 public:
  /// @param trial the baseline trial: excitations, torque, experimental conditions
  /// @throws std::invalid_argument for an unknown effect or one that the model already has, a size
  ///   outside its bounds, a free coordinate that is not observed, what DesignInputs and
  ///   MusculoskeletalProblem throw
  SeparatingDesign(const Model& model, const SystemOptions& built, const Trial& trial,
                   const MusculoskeletalProblemOptions& options, SeparationQuestion question,
                   DesignLimits limits, std::vector<bio::MuscleGroup> groups,
                   double knotInterval = 0.3);

  const DesignInputs& inputs() const { return inputs_; }
  const MusculoskeletalSystem& system() const { return system_; }
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
  /// Place of a coordinate's angle among what is observed.
  Eigen::Index placeOf(const std::string& coordinate) const;

  Model model_;
  SystemOptions built_;  ///< of `system_`
  MusculoskeletalSystem system_;
  std::vector<std::string> coordinates_;
  MusculoskeletalProblemOptions options_;
  SeparationQuestion question_;
  std::vector<Observable> observed_;
  info::discover::Whitening noise_;
  DesignInputs inputs_;
  info::discover::PresentEffect effects_[2];
  info::discover::Candidate candidates_[2];
  std::string units_[2];
};

}  // namespace bio::discover
