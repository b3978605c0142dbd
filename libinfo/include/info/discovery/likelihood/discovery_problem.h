#pragma once

#include <Eigen/Dense>
#include <memory>
#include <string>
#include <vector>

namespace info::discover {

/// What an effect touches; printed with its name, and one finalist of each kind is raced.
enum class EffectKind { structure, input, geometry, sensor, parameter };

/// One number of the encompassing model: of the base model, of a trial's start, or of an effect.
struct Quantity {
  std::string name;
  std::string unit;    ///< "" for a pure number
  double nominal = 0;  ///< what the base model says; of an effect's amplitude: 0, absent
  double lower = 0;    ///< bounds, lower ≤ nominal ≤ upper
  double upper = 0;
  double sd = 1;             ///< prior standard deviation about nominal > 0; see `logarithmic`
  bool logarithmic = false;  ///< prior and deviation are those of log(value/nominal); nominal > 0
  int trial = -1;            ///< the only trial that it belongs to (its start); -1: every trial
};

/// An effect that the base model may lack, as one entry of a catalogue.
///
/// Laws. With its first quantity, the amplitude, at nominal the effect is absent: predictions equal
/// the base model's bit for bit, whatever its other quantities are.
struct Candidate {
  std::string id;        ///< short, e.g. "visc"
  std::string name;      ///< e.g. "viscous joint damping"
  std::string sentence;  ///< what it is, in plain words
  EffectKind kind = EffectKind::structure;
  std::vector<std::size_t> quantities;  ///< indices; the amplitude first
  /// Prior deviations while this candidate is raced, one per quantity. A parameter error is a
  /// nuisance of the base model with a wider prior than there.
  std::vector<double> sds;
  /// Where refits start: values of all its quantities, at least one set. Shape quantities
  /// (limit angles, time constants) vanish from the likelihood at amplitude 0, so they get a grid.
  std::vector<Eigen::VectorXd> starts;
  std::vector<std::string> equivalents;  ///< ids that the same data can never tell from it
};

/// One term of a force c·(e_1 + r_2·e_2 + …) on what is observed.
struct FormulaTerm {
  std::string expression;  ///< e_k in q and qdot, e.g. "qdot*abs(qdot)"
  double start = 0;        ///< where fits start: c of the first term, r_k of the others
  double sd = 1;           ///< prior of that about 0
};

/// Model, recorded inputs and recorded outputs of several trials, with every effect of a catalogue
/// built in and absent by default. A hypothesis frees some effects' quantities; the engine knows
/// nothing else of mechanics.
///
///     ẋ = f(x,u,θ) + Σ_c φ_c(x,u,t;β_c) + d(t),      y_k = g(x(t_k);β) + v_k,   v_k ~ N(0, σ²)
///
/// The latent generalised force d(t) is given by its values at latentTimes(), straight lines
/// between; its prior is the sum of independent Ornstein–Uhlenbeck processes behind a lag
/// (latentLag()), of sizes σ_d·G_c(t), one for each channel c of the scale that predict() returns
/// (one for each muscle, the size of its moment, and one of constant size; else a single 1).
///
/// Laws. Pure: equal arguments give equal results, from any thread. Where the simulation fails the
/// outputs are not finite.
class DiscoveryProblem {
 public:
  virtual ~DiscoveryProblem() = default;

  /// Every number there is, the same list for every call.
  virtual const std::vector<Quantity>& quantities() const = 0;
  /// Quantities that are free in every hypothesis, with their priors: the base model's
  /// uncertain parameters and every trial's start.
  virtual const std::vector<std::size_t>& nuisances() const = 0;
  virtual const std::vector<Candidate>& candidates() const = 0;

  virtual int numTrials() const = 0;
  virtual std::string trialName(int trial) const = 0;
  /// Times of the measured samples [s], rising; several outputs share a time.
  virtual const std::vector<double>& times(int trial) const = 0;
  /// Which output each sample is of, 0 for the first, where several are measured; empty: there is
  /// one. Samples of one time follow each other, in the order of outputs; all of them have the same
  /// noise (a model weights them). Maps over (q, q̇) show the first.
  virtual const std::vector<int>& outputOfSample(int /*trial*/) const {
    static const std::vector<int> one;
    return one;
  }
  /// What was measured there; NaN is not allowed, missing samples have no time.
  virtual const Eigen::VectorXd& measured(int trial) const = 0;
  /// Nodes of the latent force [s], equally spaced over the trial.
  virtual const std::vector<double>& latentTimes(int trial) const = 0;
  /// τ [s] ≥ 0, time constant of a lag that smooths the latent force: errors of an input reach the
  /// force through the actuators' dynamics.
  virtual double latentLag() const { return 0; }

  struct Prediction {
    Eigen::VectorXd outputs;      ///< y at times(trial)
    Eigen::MatrixXd gamma;        ///< dy/dq of the wanted quantities: samples × wanted
    Eigen::MatrixXd latentGamma;  ///< dy/dd: samples × latent nodes; empty unless asked for
    Eigen::MatrixXd latentScale;  ///< G: latent nodes × channels; empty unless asked for
    Eigen::VectorXd speeds;       ///< rate of the output at times(trial), for the map over (q, q̇)
  };
  /// @param values   of all quantities
  /// @param latent   of d at latentTimes(trial) [unit of the generalised force]; empty: 0
  /// @param wanted   indices of quantities, columns of gamma in this order
  virtual Prediction predict(int trial, const Eigen::VectorXd& values,
                             const Eigen::VectorXd& latent, const std::vector<std::size_t>& wanted,
                             bool latentToo) const = 0;
  /// The outputs alone.
  virtual Eigen::VectorXd outputs(int trial, const Eigen::VectorXd& values,
                                  const Eigen::VectorXd& latent) const = 0;

  /// The outputs with time steps half as long, for the gate against numerical error; empty: not
  /// offered, the gate is then left out.
  virtual Eigen::VectorXd refinedOutputs(int /*trial*/, const Eigen::VectorXd& /*values*/) const {
    return {};
  }

  /// The same data and model with a force that holds the simulation near what was measured, as a
  /// spring and a damper of a natural frequency ω [rad/s] > 0 do (nudging). Far from the truth the
  /// simulation of an unstable model depends on its parameters in many narrow valleys; held, it
  /// depends on them smoothly, and as ω goes to 0 it becomes the model's own. Null: not offered.
  /// Must not outlive this.
  virtual std::unique_ptr<DiscoveryProblem> nudged(double /*frequency*/) const { return nullptr; }

  /// Inputs whose past the innovations must not follow, samples × inputs at times(trial), for the
  /// test of input independence; may have no columns.
  virtual Eigen::MatrixXd inputs(int trial) const = 0;
  virtual std::vector<std::string> inputNames() const = 0;

  /// The same data and model with a candidate "formula" of these terms, at least one, its
  /// quantities c, r_2, …; of the other candidates only `kept` (indices). Null: not offered.
  virtual std::unique_ptr<DiscoveryProblem> withFormula(
      const std::vector<FormulaTerm>& /*terms*/, const std::vector<std::size_t>& /*kept*/) const {
    return nullptr;
  }
};

}  // namespace info::discover
