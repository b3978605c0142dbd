#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bio/design_inputs.h"
#include "bio/discover/elbow_disagreement.h"
#include "bio/experiment_design.h"
#include "info/discover/distinction.h"

namespace bio::discover {

/// Which two effects are to be told apart, and how the coordinate is measured.
struct SeparationQuestion {
  std::string first, second;  ///< ids of the catalogue
  /// Amplitudes in their units, if they are there; 0: the prior deviation of the race, on the side
  /// of zero where the effect may be.
  double firstSize = 0, secondSize = 0;
  double start = 0;      ///< of the coordinate [rad] or [m]
  double noise = 0.009;  ///< standard deviation of a measurement [rad] or [m] > 0
  double period = 0.01;  ///< between measurements [s] > 0
};

/// One experiment and how it would tell.
struct SeparatingExperiment {
  Eigen::VectorXd inputs;  ///< coefficients of DesignInputs::profiles(); empty: the trial's own
  Trial trial;             ///< with the base model's motion as measured
  Eigen::VectorXd base, first, second;  ///< the coordinate at the measured times [rad] or [m]
  info::discover::Distinction tells;
  double lowest = 0, highest = 0, fastest = 0;  ///< of all three motions, at the measured times
  bool keepsLimits = false;
};

struct SeparatingResult {
  SeparatingExperiment before, after;
  bool improved = false;     ///< after is another experiment than before, and keeps the limits
  bool stopped = false;      ///< the callback said so
  int runs = 0;              ///< experiments that were simulated
  int impossible = 0;        ///< of them that did not reach the end
  std::vector<double> nats;  ///< of the best experiment that keeps the limits, as it was found
  std::vector<int> foundAt;  ///< run at which it was
};

/// Seeks the excitations and the torque from outside that tell two effects apart: the largest of
/// the smaller of both expected Bayes factors (info::discover::distinction), every parameter of the
/// base model being as uncertain as its tolerance says. Random inputs first, then info::evolve().
/// All motions, without an effect and with either, keep to the coordinate's range and speed.
class SeparatingDesign {
 public:
  /// @param trial  the experiment that there is: excitations, torque, known changes
  /// @throws std::invalid_argument for an unknown effect or one that the model has already, a size
  ///   outside its bounds, what DesignInputs and ElbowDisagreement throw
  SeparatingDesign(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                   const Trial& trial, const ElbowOptions& options, SeparationQuestion question,
                   const DesignLimits& limits, std::vector<bio::MuscleGroup> groups,
                   double knotInterval = 0.3);

  const DesignInputs& inputs() const { return inputs_; }
  const SeparationQuestion& question() const { return question_; }
  /// The catalogue's entries.
  const info::discover::Candidate& first() const { return candidates_[0]; }
  const info::discover::Candidate& second() const { return candidates_[1]; }
  const std::string& unitOfFirst() const { return units_[0]; }
  const std::string& unitOfSecond() const { return units_[1]; }

  /// @throws std::domain_error where one of the motions does not reach the end
  SeparatingExperiment before() const { return at({}); }
  SeparatingExperiment at(const Eigen::VectorXd& x) const;

  /// `settings.iterations` means nothing here.
  /// @throws std::domain_error if the trial itself cannot be simulated with and without the effects
  SeparatingResult search(const DesignSearchSettings& settings) const;

 private:
  ElbowDisagreement planned(const Trial& trial) const;
  double price(const SeparatingExperiment& e) const;

  Model model_;
  ArmOptions arm_;
  std::string coordinate_;
  ElbowOptions options_;
  SeparationQuestion question_;
  DesignInputs inputs_;
  info::discover::PresentEffect effects_[2];
  info::discover::Candidate candidates_[2];
  std::string units_[2];
};

}  // namespace bio::discover
