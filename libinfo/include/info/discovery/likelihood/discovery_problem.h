#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>
#include <vector>

namespace info::discover {

/// The part of the model that an effect changes; printed with its name. At least one finalist of
/// each kind is fitted.
enum class EffectKind { structure, input, geometry, sensor, parameter };

/// One quantity of the encompassing model: of the base model, of a trial's initial state, or of an
/// effect.
struct Quantity {
  std::string name;
  std::string unit;    ///< "" if dimensionless
  double nominal = 0;  ///< value of the base model; amplitude of an absent effect: 0
  double lower = 0;    ///< bounds, lower ≤ nominal ≤ upper
  double upper = 0;
  double sd = 1;             ///< prior standard deviation about nominal > 0; see `logarithmic`
  bool logarithmic = false;  ///< prior and deviation are those of log(value/nominal); nominal > 0
  int trial = -1;            ///< the trial whose initial state it belongs to; -1: all trials
  /// Prior probability that it is exactly nominal, 0 to below 1; `sd` is that of the prior
  /// otherwise. A shape parameter with a usual value, such as a spring's rest position, then costs
  /// its effect next to no evidence where it has this value, however little is known of other ones.
  double nominalShare = 0;
};

/// An effect that may be missing in the base model: one entry of a catalogue.
///
/// Contract: with its first quantity, the amplitude, at its nominal value the effect is absent.
/// Predictions then equal those of the base model bit for bit, for any values of its other
/// quantities.
struct Candidate {
  std::string id;        ///< short, e.g. "visc"
  std::string name;      ///< e.g. "viscous damping"
  std::string sentence;  ///< a description in plain words
  EffectKind kind = EffectKind::structure;
  std::vector<std::size_t> quantities;  ///< indices; the amplitude first
  /// Prior standard deviations of this candidate's quantities, one per quantity. A parameter error
  /// is a nuisance parameter of the base model with a wider prior.
  std::vector<double> sds;
  /// Starting values of fits: values of all its quantities, at least one set. At amplitude 0 the
  /// likelihood does not depend on shape parameters (limits, time constants), which therefore
  /// start from a grid of values.
  std::vector<Eigen::VectorXd> starts;
  std::vector<std::string>
      equivalents;  ///< ids of effects that such data can never distinguish from it
};

/// A coordinate on which a latent force may act.
struct Axis {
  std::string name;
  std::string unit;       ///< of the coordinate
  std::string forceUnit;  ///< of the generalised force on it
  /// s > 0 of formulas' tanh(q̇/s), a force that changes its sign with the speed: small beside usual
  /// speeds [unit/s].
  double smallSpeed = 0.05;

  /// Whether its sine has a meaning.
  bool isInRadians() const { return unit.empty() || unit == "rad"; }
};

/// A node of the latent force.
struct Node {
  double time = 0;       ///< [s]
  std::size_t axis = 0;  ///< index into DiscoveryProblem::axes()
};

/// One term of a force c·(e_1 + r_2·e_2 + …) on one axis.
struct FormulaTerm {
  std::string expression;  ///< e_k in that axis's q and its rate qdot, e.g. "qdot*abs(qdot)"
  double start = 0;        ///< starting value of fits: c for the first term, r_k for the others
  double sd = 1;           ///< prior standard deviation about 0
};

/// The problem of discovery: a model, the recorded inputs and outputs of several trials, and a
/// catalogue of effects that are built into the model and absent by default. A hypothesis frees the
/// quantities of some effects. The search uses no other knowledge of the system.
///
///     ẋ = f(x,u,θ) + Σ_c φ_c(x,u,t;β_c) + d(t),      y_k = g(x(t_k);β) + v_k,   v_k ~ N(0, σ²)
///
/// The latent generalised force d(t) has a component on every axis, given by its values at nodes()
/// with linear interpolation in time; its prior is the sum of independent Ornstein–Uhlenbeck
/// processes, filtered by a first-order lag (latentLag()), with standard deviations σ_d·G_c(t) for
/// the channels c of the scale that predict() returns: for instance one per input, scaled by the
/// moments of its actuator about all axes, then one of constant scale per axis; or a single channel
/// of scale 1. A channel that acts on several axes couples their forces.
///
/// Contract: pure, i.e. equal arguments give equal results, from any thread. If the simulation
/// fails, the outputs are not finite.
class DiscoveryProblem {
 public:
  virtual ~DiscoveryProblem() = default;

  /// All quantities; every call returns the same list.
  virtual const std::vector<Quantity>& quantities() const = 0;
  /// Nuisance parameters, free in every hypothesis, with their priors: the base model's uncertain
  /// parameters and the initial state of every trial.
  virtual const std::vector<std::size_t>& nuisances() const = 0;
  virtual const std::vector<Candidate>& candidates() const = 0;

  virtual int numTrials() const = 0;
  virtual std::string trialName(int trial) const = 0;
  /// Times of the measured samples [s], rising; several outputs share a time.
  virtual const std::vector<double>& times(int trial) const = 0;
  /// Index of each sample's output, from 0, if several outputs are measured; empty: one output.
  /// Samples of one time are consecutive, in the order of the outputs; all have the same noise (the
  /// model weights them).
  virtual const std::vector<int>& outputOfSample(int /*trial*/) const {
    static const std::vector<int> one;
    return one;
  }
  /// Measured values at these times; NaN is not allowed, missing samples have no time.
  virtual const Eigen::VectorXd& measured(int trial) const = 0;
  /// The coordinates on which the latent force acts, at least one. Maps over (q, q̇) and formulas
  /// are told axis by axis.
  virtual const std::vector<Axis>& axes() const {
    static const std::vector<Axis> one(1);
    return one;
  }
  /// Nodes of the latent force: those of axis 0 in rising, equally spaced times over the trial,
  /// then those of axis 1, …; all axes at the same times.
  virtual const std::vector<Node>& nodes(int trial) const = 0;
  /// τ [s] ≥ 0, time constant of the lag that filters the latent force: errors of an input act on
  /// the force through the actuators' dynamics.
  virtual double latentLag() const { return 0; }

  /// The simulated coordinate of each node's axis and its rate, at the node's time: the state
  /// itself, not what a sensor shows of it. A node outside the simulation has the nearest state.
  struct Course {
    Eigen::VectorXd q;     ///< [unit of the axis]
    Eigen::VectorXd qDot;  ///< [unit of the axis/s]
  };
  /// `byNode`, `scale`, `course` and `courseByNode` are empty unless requested.
  struct Prediction {
    Eigen::VectorXd outputs;       ///< y at times(trial)
    Eigen::MatrixXd gamma;         ///< dy/dq of the wanted quantities: samples × wanted
    Eigen::MatrixXd byNode;        ///< dy/dd: samples × nodes
    Eigen::MatrixXd scale;         ///< G: nodes × channels
    Eigen::VectorXd speeds;        ///< rate of each sample's output at times(trial)
    Course course;                 ///< at nodes(trial)
    Eigen::MatrixXd courseByNode;  ///< ∂(course.q)/∂d: nodes × nodes
  };
  /// @param values   of all quantities
  /// @param latent   of d at nodes(trial) [units of the generalised forces]; empty: 0
  /// @param wanted   indices of quantities, columns of gamma in this order
  virtual Prediction predict(int trial, const Eigen::VectorXd& values,
                             const Eigen::VectorXd& latent, const std::vector<std::size_t>& wanted,
                             bool latentToo) const = 0;
  /// A simulation whose derivatives are computed when they are asked for.
  class Simulation {
   public:
    virtual ~Simulation() = default;
    virtual const Eigen::VectorXd& outputs() const = 0;
    /// The result of predict() with the same arguments; to be called once at most.
    virtual Prediction predict() = 0;
  };
  /// The arguments of predict(); must not outlive this object. Null: not available, predict() and
  /// outputs() are called instead.
  virtual std::unique_ptr<Simulation> simulated(int /*trial*/, const Eigen::VectorXd& /*values*/,
                                                const Eigen::VectorXd& /*latent*/,
                                                const std::vector<std::size_t>& /*wanted*/,
                                                bool /*latentToo*/) const {
    return nullptr;
  }
  /// The outputs alone.
  virtual Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                                  const Eigen::VectorXd& latent) const = 0;

  /// The outputs at half the time step, for the test of the numerical error; empty: not available,
  /// the test is omitted.
  virtual Eigen::VectorXd refinedOutputs(int /*trial*/, const Eigen::VectorXd& /*values*/) const {
    return {};
  }

  /// This problem with a force that pulls the simulation towards the measurements like a
  /// spring and damper with natural frequency ω [rad/s] > 0 (nudging). Far from the solution, the
  /// cost of an unstable model has many narrow local minima; with nudging it is smooth, and for ω →
  /// 0 the original model is recovered. Null: not available. Must not outlive this object.
  virtual std::unique_ptr<DiscoveryProblem> nudged(double /*frequency*/) const { return nullptr; }

  /// Inputs, samples × inputs at times(trial), whose past values must not be correlated with the
  /// innovations (test of input independence); may have no columns.
  virtual Eigen::MatrixXd inputs(int trial) const = 0;
  virtual std::vector<std::string> inputNames() const = 0;

  /// This problem with a candidate "formula", a force of these terms (at least one) on
  /// an axis, with the quantities c, r_2, …; of the other candidates only `kept` (indices). Null:
  /// not available.
  virtual std::unique_ptr<DiscoveryProblem> withFormula(
      std::size_t /*axis*/, const std::vector<FormulaTerm>& /*terms*/,
      const std::vector<std::size_t>& /*kept*/) const {
    return nullptr;
  }
};

}  // namespace info::discover
