#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bio/analysis/replay.h"
#include "bio/discovery/effects.h"
#include "bio/discovery/encompassing_model.h"
#include "bio/observation/nudge.h"
#include "bio/sensitivity/coupled_sensitivity.h"
#include "bio/simulation/simulate.h"
#include "bio/tables/trial.h"

namespace bio::discover {

class SensedMotion;

/// Sensors, motions and drives that are not chosen are those of the trials.
struct MusculoskeletalProblemOptions : CatalogueChoice {
  SimulationOptions simulation;  ///< integrator: variational or variationalLeft; step
  double latentSpacing = 0.05;   ///< between nodes of the latent force [s] > 0
  /// τ_0 of its scale [N·m] > 0; without muscles, whose errors it stands for, times a fortieth of
  /// the largest weight of what moves, in [N m], or a 160th of that weight in [N].
  double latentFloor = 0.5;
  double startSd = 0.035;  ///< prior sd of each trial's initial angle [rad] > 0; a shift
                           ///< has an eighth of it [m]
  double speedSd = 0.1;    ///< prior sd of each trial's initial speed [rad/s] > 0, or an
                           ///< eighth of it [m/s]; of one that starts in motion: as large
                           ///< as that speed
  /// Initial values of free coordinates [rad] or [m], at rest, that the prior of every trial's
  /// initial state has as its mean; the others are as measured.
  std::map<std::string, double> initial = {};
  bool trialsAreCut = false;  ///< they are parts of those in the files
  bool usableSeries = true;   ///< refuse measured series that requireUsable refuses
};

/// A search with too long a step is repeated with half the step, unless the step was shorter than
/// this [s] (info::discover::runAtShorterSteps). From 10 ms it goes down to 0.6 ms: with a precise
/// sensor 1 ms moves the real pendulum of validation/real by 0.4 of its noise.
inline constexpr double shortestSearchStep = 0.0008;

/// The observables that trials measure, in a problem's order: the coordinates in question that are
/// not prescribed, then all other channels.
std::vector<Observable> measuredOutputs(const std::vector<Trial>& trials,
                                        const SystemOptions& system,
                                        const std::vector<std::string>& coordinates);

/// The coordinates in question of trials: all free ones; where none is free, those of `held`
/// (prescribed or locked) whose moment a trial measures, without trials all of them. Empty: none.
std::vector<std::string> coordinatesInQuestion(const std::vector<std::string>& free,
                                               const std::vector<std::string>& held,
                                               const std::vector<Trial>& trials);

/// The discovery problem of a musculoskeletal model for info::discover: recorded trials, and the
/// model with every effect of the catalogue built in. Outputs are the measured coordinates among
/// those in question and all other channels that the trials measure (Observable), in this order.
///
/// Each trial is simulated over its rows from its own initial state, driven by its excitations, its
/// external torques and the course of prescribed coordinates. The prior mean of an initial angle is
/// the one given, as it is, whatever a sensor shows; else the first measured value as the sensor,
/// which may be in error, shows it; the default of one that is not measured, with ten times the
/// deviation. SensedMotion gives what the sensors show.
/// All derivatives are exact: those of parameters, forces and latent nodes by the implicit function
/// theorem (coupled_sensitivity.h), those of EMG and sensor by the chain rule. Before the start of
/// a trial, which a clock offset may require, the coordinate is extrapolated with its initial
/// speed.
///
/// If an external torque acts on the coordinate, delay and clock are not equivalent. A known mass
/// in the hand (Trial::known) is part of the model of its trial; if it differs between trials, tilt
/// and handforce are not equivalent. In a trial with a known turn of the limb, gravity and a force
/// on the hand are turned accordingly.
///
/// The latent force acts on every coordinate in question, its axes, with one channel per muscle,
/// scaled by the muscle's moments r_i F_i on all of them, and one of the constant scale τ_0 [N·m]
/// on each: independent relative errors of each muscle's force, and other errors. Its time constant
/// is that of the activations, 1/k at the mean excitation, k midway between rising and falling.
class MusculoskeletalProblem : public info::discover::DiscoveryProblem {
 public:
  using Quantity = info::discover::Quantity;
  using Candidate = info::discover::Candidate;

  /// @param coordinates those in question; missing samples have no time
  /// @throws std::invalid_argument what EncompassingModel, ObservedMotion and startCoordinates
  ///   throw, no trial, a trial without a measured value, an integrator without sensitivities, an
  ///   option out of range, a known mass in the hand of a model without a body to carry it
  MusculoskeletalProblem(const Model& model, const SystemOptions& system,
                         const CoordinateNames& coordinates, std::vector<Trial> trials,
                         MusculoskeletalProblemOptions options = {});

  const std::vector<Quantity>& quantities() const override { return quantities_; }
  const std::vector<std::size_t>& nuisances() const override { return nuisances_; }
  const std::vector<Candidate>& candidates() const override { return encompassing_.candidates(); }
  int numTrials() const override { return static_cast<int>(trials_.size()); }
  std::string trialName(int trial) const override { return of(trial).trial.file; }
  const std::vector<double>& times(int trial) const override { return of(trial).times; }
  const std::vector<int>& outputOfSample(int trial) const override { return of(trial).outputs; }
  const Eigen::VectorXd& measured(int trial) const override { return of(trial).measured; }
  const std::vector<info::discover::Axis>& axes() const override { return axes_; }
  const std::vector<info::discover::Node>& nodes(int trial) const override {
    return of(trial).nodes;
  }
  double latentLag() const override { return latentLag_; }
  Prediction predict(int trial, const Eigen::VectorXd& values, const Eigen::VectorXd& latent,
                     const std::vector<std::size_t>& wanted, bool latentToo) const override;
  std::unique_ptr<Simulation> simulated(int trial, const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& latent,
                                        const std::vector<std::size_t>& wanted,
                                        bool latentToo) const override;
  Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& latent) const override;
  Eigen::VectorXd refinedOutputs(int trial, const Eigen::VectorXd& values) const override;
  Eigen::MatrixXd inputs(int trial) const override;
  std::vector<std::string> inputNames() const override;
  /// This problem with measured coordinates held near their courses (nudge.h); null if one of them
  /// has fewer than four samples, or none is measured.
  std::unique_ptr<info::discover::DiscoveryProblem> nudged(double frequency) const override;
  /// Null if the model already has the force of a formula.
  std::unique_ptr<info::discover::DiscoveryProblem> withFormula(
      std::size_t axis, const std::vector<info::discover::FormulaTerm>& terms,
      const std::vector<std::size_t>& kept) const override;

  /// Model and effects, without the initial states of the trials.
  const EncompassingModel& encompassing() const { return encompassing_; }
  /// Sum of the timed forces at nodes(trial); empty if there is none.
  Eigen::VectorXd timedForce(int trial, const Eigen::VectorXd& values) const;
  const MusculoskeletalProblemOptions& options() const { return options_; }
  /// The trial as given, with an excitation for every muscle that was added (withSynergists).
  const Trial& trial(int trial) const { return of(trial).trial; }
  /// The complete simulation at `values`, without a latent force.
  /// @throws what MusculoskeletalSystem, initialState and simulate throw
  Trajectory motion(int trial, const Eigen::VectorXd& values) const;
  /// The generalised forces that keep the model at `values` on a motion of the trial: with its
  /// excitations, external and timed forces (inverse_dynamics.h).
  Trajectory inverseDynamics(int trial, const Eigen::VectorXd& values,
                             const Trajectory& motion) const;
  /// The model that it belongs to.
  MusculoskeletalSystem systemAt(int trial, const Eigen::VectorXd& values) const;
  /// Its initial state by coordinate: the coordinate itself, not the sensor's reading.
  std::vector<TrialStart> startsAt(int trial, const Eigen::VectorXd& values) const;
  /// Why the trial's simulation does not reach its end; empty if it does.
  std::string failure(int trial, const Eigen::VectorXd& values) const;

 private:
  class Nudged;
  class Run;
  /// Samples of one sensor in a trial.
  struct Series {
    std::size_t sensor;
    std::vector<double> times;
    std::vector<Eigen::Index> samples;  ///< places among those of the trial
  };
  /// The initial state of a coordinate that is free to move.
  struct Start {
    std::size_t coordinate;    ///< of EncompassingModel::coordinates()
    std::size_t angle, speed;  ///< quantities, the angle as the sensor shows it
    int sensor;                ///< that shows it; −1: none
  };
  struct OfTrial {
    Trial trial;
    RecordedTrial recorded;
    std::vector<double> times;
    std::vector<int> outputs;  ///< of the samples; empty: one output
    Eigen::VectorXd measured;
    std::vector<Series> series;
    std::vector<double> nodeTimes;
    std::vector<info::discover::Node> nodes;
    Eigen::VectorXd heldMass;    ///< moment of a mass of 1 kg at the nodes [N·m]
    Eigen::VectorXd conditions;  ///< change of the model's quantities by Trial::known
    std::vector<Start> starts;
  };
  Eigen::VectorXd withTimedForces(const OfTrial& trial, const Eigen::VectorXd& values,
                                  const Eigen::VectorXd& latent) const;
  /// Derivatives of the forces at the nodes with respect to the wanted quantities: nodes × wanted;
  /// empty if they depend on none.
  Eigen::MatrixXd timedDirections(const OfTrial& trial, const Eigen::VectorXd& values,
                                  const std::vector<std::size_t>& wanted) const;
  /// ∂(external force) in the wanted quantities of drives, at their places among the columns.
  std::vector<ExternalSlope> driveSlopes(const OfTrial& trial, const Eigen::VectorXd& values,
                                         const std::vector<std::size_t>& wanted,
                                         const std::vector<Eigen::Index>& places,
                                         const MusculoskeletalSystem& system) const;
  double activationLag() const;
  void addTrial(Trial trial);
  void collectSamples(OfTrial& trial) const;
  void addNodes(OfTrial& trial) const;
  void addStarts(OfTrial& trial);
  /// A number of the initial state of the trial that is being added; its place.
  std::size_t addOwnQuantity(const std::string& what, Quantity quantity);
  /// Equivalent candidates that these trials distinguish.
  void separateWhatTrialsTellApart();
  const OfTrial& of(int trial) const { return trials_.at(static_cast<std::size_t>(trial)); }
  ParameterCatalogue::Setting settingAt(const OfTrial& trial, const Eigen::VectorXd& values,
                                        const std::vector<std::size_t>& wanted) const;
  SimulationOptions simulationOf(const OfTrial& trial, const Eigen::VectorXd& values,
                                 const Eigen::VectorXd& latent) const;
  /// The sensors of the trial's series, on a system that is that of `values`.
  std::vector<SensedMotion> sensedBy(const MusculoskeletalSystem& system, const OfTrial& trial,
                                     const Eigen::VectorXd& values) const;
  ExcitationSignal excitationFor(const OfTrial& trial, const MusculoskeletalSystem& system) const;
  struct Simulated {
    MusculoskeletalSystem system;
    Trajectory motion;
  };
  Simulated simulate(const OfTrial& trial, const Eigen::VectorXd& values,
                     const Eigen::VectorXd& latent, double stepFactor,
                     const std::vector<Nudge>* nudges) const;
  Eigen::VectorXd outputsOf(const OfTrial& trial, const Eigen::VectorXd& values,
                            const Eigen::VectorXd& latent, double stepFactor,
                            const std::vector<Nudge>* nudges) const;
  /// Columns of a simulation's sensitivities that the wanted quantities follow.
  struct Columns;
  Columns columnsOf(const OfTrial& trial, const Eigen::VectorXd& values,
                    const std::vector<std::size_t>& wanted) const;
  /// Scales of the latent force at the nodes: the muscles' moments, and the floor.
  Eigen::MatrixXd latentScale(const OfTrial& trial, const MusculoskeletalSystem& system,
                              const Trajectory& motion) const;
  std::unique_ptr<Simulation> simulatedWith(const std::vector<Nudge>* nudges, int trial,
                                            const Eigen::VectorXd& values,
                                            const Eigen::VectorXd& latent,
                                            const std::vector<std::size_t>& wanted,
                                            bool latentToo) const;
  Prediction predictWith(const std::vector<Nudge>* nudges, int trial, const Eigen::VectorXd& values,
                         const Eigen::VectorXd& latent, const std::vector<std::size_t>& wanted,
                         bool latentToo) const;

  MusculoskeletalProblemOptions options_;  ///< with a choice of everything
  EncompassingModel encompassing_;
  std::vector<Quantity> quantities_;  ///< those of the model, then the initial states of the trials
  std::vector<std::size_t> nuisances_;
  std::vector<info::discover::Axis> axes_;  ///< the coordinates
  std::vector<OfTrial> trials_;
  double latentLag_ = 0;
  std::vector<double> latentFloors_;  ///< by coordinate
};

}  // namespace bio::discover
