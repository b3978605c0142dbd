#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bio/coupled.h"
#include "bio/discover/widest_model.h"
#include "bio/nudge.h"
#include "bio/trial.h"

namespace bio::discover {

struct ElbowOptions {
  SimulationOptions simulation;      ///< integrator: variational or variationalLeft; step
  double latentSpacing = 0.05;       ///< between nodes of the latent force [s] > 0
  double latentFloor = 0.5;          ///< τ_0 of its scale [N·m] > 0
  double startDeviation = 0.035;     ///< prior of each trial's first angle [rad] > 0
  double speedDeviation = 0.1;       ///< prior of each trial's first speed [rad/s] > 0
  std::vector<std::string> without;  ///< ids of effects that are left out of the catalogue
  std::vector<info::discover::FormulaTerm> formula;  ///< of a candidate "formula"; empty: none
};

/// A search whose steps were too long is repeated with half of them, unless they were shorter than
/// this [s] (info::discover::runAtShorterSteps).
inline constexpr double shortestSearchStep = 0.003;

/// A model and recorded trials with one observed coordinate, every effect of the catalogue built
/// in: what info::discover asks.
///
/// Each trial is simulated from its own first angle over its rows, driven by its excitations and by
/// the torque it has from outside; what is known of that angle is the first measured value, as a
/// sensor that may be off shows it. y(t_k) is the cubic of Hermite between rows. All derivatives
/// are exact: parameters, laws and latent nodes by the implicit function theorem
/// (coupled_sensitivity.h), EMG and sensor by the chain rule; none is a difference of simulations.
/// Before the start of a trial, where a clock offset may look, the coordinate goes on with its
/// first speed.
///
/// Where a torque from outside pushes the coordinate, delay and clock are no equivalents. A mass in
/// the hand that a trial is known to have (Trial::known) is in its model besides what is missing;
/// where it differs between trials, tilt and handforce are no equivalents. In one whose arm is
/// known to be turned, gravity and a force on the hand come from where they then come from.
///
/// The latent force is a torque on the coordinate with a channel for each muscle, the size of its
/// moment r_i F_i, and one of the constant size τ_0 [N·m]: independent errors of so many per cent
/// of each muscle's force, and of something else. Its lag is that of the activations, 1/k at the
/// mean excitation, k midway between rising and falling.
class ElbowDisagreement : public info::discover::Disagreement {
 public:
  using Quantity = info::discover::Quantity;
  using Candidate = info::discover::Candidate;

  /// @param coordinate  observed; measured in every trial; samples that are missing have no time
  /// @throws std::invalid_argument what WidestModel throws, no trial, a trial without a measured
  ///   value of the coordinate, an integrator without sensitivities, an option out of range, a
  ///   known mass in the hand of an arm that has none
  ElbowDisagreement(const Model& model, const ArmOptions& arm, const std::string& coordinate,
                    std::vector<Trial> trials, ElbowOptions options = {});

  const std::vector<Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<Candidate>& candidates() const override { return widest_.candidates(); }
  int numTrials() const override { return static_cast<int>(trials_.size()); }
  std::string trialName(int trial) const override { return of(trial).trial.file; }
  const std::vector<double>& times(int trial) const override { return of(trial).times; }
  const Eigen::VectorXd& measured(int trial) const override { return of(trial).measured; }
  const std::vector<double>& latentTimes(int trial) const override { return of(trial).nodes; }
  double latentLag() const override { return latentLag_; }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override;
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override;
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override;
  Eigen::MatrixXd inputs(int trial) const override;
  std::vector<std::string> inputNames() const override;
  /// The same with the coordinate held near its measured course (nudge.h).
  std::unique_ptr<info::discover::Disagreement> nudged(double frequency) const override;
  /// Null if the model has a force of a formula already.
  std::unique_ptr<info::discover::Disagreement> withFormula(
      const std::vector<info::discover::FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override;

  /// Model and effects, without the trials' starts.
  const WidestModel& widest() const { return widest_; }
  /// Forces that begin or end, together, at latentTimes(trial); empty if there is none.
  Eigen::VectorXd timedForce(int trial, const Eigen::VectorXd& values) const;
  const ElbowOptions& options() const { return options_; }
  /// The trial as it was given, with an excitation for every muscle that was added (withProxies).
  const Trial& trial(int trial) const { return of(trial).trial; }
  /// The whole simulation at values, without a latent force.
  /// @throws what Arm, initialState and simulate throw
  Trajectory motion(int trial, const Eigen::VectorXd& values) const;
  /// The arm that it is of.
  Arm armAt(int trial, const Eigen::VectorXd& values) const;
  /// Where it starts: the coordinate itself, not what the sensor shows of it.
  TrialStart startAt(int trial, const Eigen::VectorXd& values) const;
  /// Why the trial's simulation does not reach its end; empty if it does.
  std::string failure(int trial, const Eigen::VectorXd& values) const;

 private:
  class Nudged;
  struct OfTrial {
    Trial trial;
    ExcitationSignal excitation;
    ExternalForce external;
    std::vector<double> times;
    Eigen::VectorXd measured;
    std::vector<double> nodes;
    Eigen::VectorXd heldMass;  ///< what one of 1 kg does at the nodes [N·m]
    Eigen::VectorXd known;     ///< what Trial::known adds to the model's quantities
    std::size_t angle, speed;  ///< quantities of its start, the angle as the sensor shows it
  };
  Eigen::VectorXd withTimedForces(const OfTrial& one, const Eigen::VectorXd& values,
                                  const Eigen::VectorXd& latent) const;
  /// How the forces at the nodes follow the wanted quantities: nodes × wanted; empty if none does.
  Eigen::MatrixXd timedDirections(const OfTrial& one, const Eigen::VectorXd& values,
                                  const std::vector<std::size_t>& wanted) const;
  double activationLag() const;
  const OfTrial& of(int trial) const { return trials_.at(static_cast<std::size_t>(trial)); }
  ParameterCatalogue::Setting settingAt(const OfTrial& one, const Eigen::VectorXd& values,
                                        const std::vector<std::size_t>& wanted) const;
  SimulationOptions simulationOf(const OfTrial& one, const Eigen::VectorXd& latent,
                                 const SensorLaw& sensor) const;
  ExcitationSignal excitationFor(const OfTrial& one, const Arm& arm) const;
  Trajectory simulate(const OfTrial& one, const Eigen::VectorXd& values,
                      const Eigen::VectorXd& latent, double stepFactor, const Nudge* nudge) const;
  Eigen::VectorXd outputsOf(const OfTrial& one, const Eigen::VectorXd& values,
                            const Eigen::VectorXd& latent, double stepFactor,
                            const Nudge* nudge) const;
  Prediction predictWith(const Nudge* nudge, int trial, const Eigen::VectorXd& values,
                         const Eigen::VectorXd& latent, const std::vector<std::size_t>& wanted,
                         bool latentToo) const;

  WidestModel widest_;
  ElbowOptions options_;
  std::vector<Quantity> quantities_;  ///< the model's, then the trials' starts
  std::vector<std::size_t> nuisances_;
  std::vector<OfTrial> trials_;
  double latentLag_ = 0;
};

}  // namespace bio::discover
