#pragma once

#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "info/discovery/judgement/adequacy.h"
#include "info/discovery/judgement/excess_error.h"
#include "info/discovery/judgement/localise.h"
#include "info/discovery/likelihood/discovery_problem.h"
#include "info/discovery/likelihood/recorded_noise.h"
#include "info/discovery/nonparametric/unknown.h"

namespace info::discover {

/// The kinds of answer that there are.
enum class Finding {
  none,       ///< nothing is missing that is larger than Verdict::detectability says
  parameter,  ///< a parameter of the base model is further off than its tolerance
  named,      ///< one effect, or several that act together, each without a rival
  ambiguous,  ///< one of several effects that these data cannot tell apart
  unknown,    ///< something is missing that no effect of the catalogue explains
  numerical,  ///< the base model's own time steps are too long to say anything
};

enum class Stage { calibrate, localise, screen, race, decide, finished };

struct Progress {
  Stage stage = Stage::calibrate;
  double fraction = 0;  ///< of the whole, 0 to 1
  std::string doing;    ///< e.g. "race: visc"
};

struct Options {
  /// σ_y [unit of the output]; empty: estimated from the data's third differences
  std::optional<double> outputSd;
  double latentTime = 0.08;        ///< ℓ [s] of the latent force
  double latentScale = 0.02;       ///< s of the prior exp(−σ_d/s) that prefers σ_d = 0
  double latentTolerance = 0.075;  ///< up to this size the latent force may be noise of the inputs
  double evidence = 5;             ///< nats that a name must be ahead of the hypothesis without it
  double significance = 3.5;       ///< deviations that its amplitude must differ from absence by
  double remainder =
      3;  ///< nats that a further disturbance with a cause may gain, or a force without a name
  double classWidth = 4.6;         ///< nats: rivals no further behind than this stay in the class
  double surprise = 3;             ///< prior deviations beyond which a parameter is in error
  double level = 0.001;            ///< of every test of adequacy
  double falseDiscoveries = 0.05;  ///< share among what the score map lights up
  int maxEffects = 3;
  int finalists = 9;         ///< most candidates that are raced at a time
  std::vector<int> heldOut;  ///< trials that are not fitted, only judged by
  /// Largest change at half the time step [σ_y]; with a larger one the finding is `numerical`.
  double numericalTolerance = 0.2;
  bool judgeSamples = true;  ///< leave out outliers, and samples whose noise is correlated
  bool symbolic = true;      ///< look for a formula when no name fits
  /// runAtShorterSteps: where nothing was found and errors as large as those of the held-out trials
  /// are less probable than this, these are fitted, too, and all is asked once more; 0: never
  double secondLook = 0.05;
  /// Less probable errors of held-out trials are told of, and a name has no probability with them.
  double farOff = 0.01;
  /// Called between fits; false ends the work, and what has been finished is in the verdict.
  std::function<bool(const Progress&)> progress;
};

/// One quantity as a hypothesis has it.
struct Estimate {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  double value = 0;
  double sd = 0;  ///< of the posterior, in the unit of the quantity
  double surprise =
      0;  ///< (value − nominal)/prior deviation; of the logarithm where that is normal
  bool atBound = false;  ///< within a millionth of its range of a bound
};

/// A hypothesis that was raced.
struct Finalist {
  std::vector<std::size_t> effects;  ///< indices into DiscoveryProblem::candidates()
  double logEvidence = 0;   ///< log Z − log Z of the base: nats, each at its own best σ_d
  double latentSize = 0;    ///< that σ_d
  double probability = 0;   ///< among all that were raced with as many effects, and fewer
  double significance = 0;  ///< |amplitude − nominal|/deviation, of the least one
  bool adequate = false;    ///< for the leader and its rivals; the others are not tested
  std::vector<Estimate> estimates;  ///< of the effects' quantities
};

/// An effect that is said to be missing, and what it cannot be told from.
struct NamedEffect {
  std::size_t candidate = 0;
  std::vector<Estimate> estimates;  ///< of its quantities, the amplitude first
  double logBayesFactor = 0;        ///< nats by which it improves on the others alone
  /// Of this name against the others in its place; NaN of a surrogate, which is not believed.
  double probability = 0;
  std::vector<std::size_t> equals;    ///< candidates in its class, itself first
  std::vector<double> equalEvidence;  ///< log Z of those less that of the leader
  bool exact = false;                 ///< true: some of them are equivalent by declaration
};

/// The smallest amplitude of a candidate that these data would have shown, 5/√S_cc.
struct Detectable {
  std::size_t candidate = 0;
  double amplitude = 0;  ///< [unit of the amplitude]; infinite: they can never show it
};

struct Verdict;

/// How the formula of what has no name (Unknown) did in the race against the effects that imitate
/// it best. It is no name: what it says is how the force looks.
struct RacedFormula {
  bool wins = false;          ///< alone: as a name it would have been given without a rival
  double logBayesFactor = 0;  ///< nats by which it improves on the base model
  double significance = 0;    ///< |c|/deviation, for given r_k
  std::vector<FormulaTerm> terms;
  std::string text;            ///< with values, e.g. "-1.48·(q³ - 3.6·q²)"
  std::vector<double> values;  ///< c, then r_2, … (FormulaTerm)
  std::vector<double> sds;
  Adequacy after;   ///< of the innovations, with the formula
  ExcessError gap;  ///< on the trials that were fitted
  std::optional<ExcessError> heldOut;
  /// Where it wins: the data with the formula as a candidate, and what the race of it said.
  std::shared_ptr<const DiscoveryProblem> data;
  std::shared_ptr<const Verdict> verdict;
};

/// A force without a name, a smooth function of the angle or of the speed alone, as it did in the
/// race against the names (docs/decisions/047-nonparametric-forces.md).
struct NonparametricForce {
  enum class Follows { angle, speed };
  Follows follows = Follows::angle;
  std::vector<std::size_t> besides;  ///< names that stay beside it: candidates
  double logBayesFactor = 0;         ///< nats by which it improves on the base model, with those
  /// Nats by which it beats the names, or the base model where there are none; Options::evidence
  /// paid for each effect.
  double ahead = 0;
  bool wins = false;       ///< by more than Options::remainder: the names are makeshifts
  std::vector<double> at;  ///< where the trials have been [unit of the output, or of its rate]
  Eigen::VectorXd force;   ///< there [unit of the generalised force]
  Eigen::VectorXd sd;      ///< of that
};

/// What was found. Everything up to `reached` is filled in; of a search that was stopped after the
/// base model was fitted also the localisation, and the finalists that there were by then.
struct Verdict {
  Stage reached = Stage::calibrate;
  Finding finding = Finding::none;
  std::string sentence;              ///< the finding in plain words
  std::vector<NamedEffect> effects;  ///< in the order they were found; for unknown: the surrogate
  double probability = 0;            ///< of all effects together; 0 where it was vetoed
  /// Named, but without a probability: the innovations have the wrong size, or the held-out trials
  /// are too far off (Options::farOff).
  bool vetoed = false;
  bool proxy = false;  ///< finding unknown: `effects` only imitates what is missing
  /// Nothing was found without the held-out trials, whose errors were too large for that; all this
  /// is of a fit of all trials, and none is left to judge by (Options::secondLook).
  bool heldOutFitted = false;

  double outputSd = 0;  ///< σ_y
  bool sdEstimated = false;
  RecordedNoise noise;                   ///< which samples were used, and why not all
  double latentSizeBefore = 0;           ///< σ_d with the base model
  double latentSizeAfter = 0;            ///< σ_d with the effects
  Eigen::VectorXd base;                  ///< all quantities, base model calibrated
  Eigen::VectorXd values;                ///< all quantities with the effects
  std::vector<Estimate> calibration;     ///< nuisances of the base model
  std::vector<Estimate> nuisancesAfter;  ///< with the effects
  /// Starts of the trials that were held out, fitted to each of them alone, with the effects; their
  /// values are in `values`, and without the effects in `base`.
  std::vector<Estimate> heldOutStarts;
  Adequacy before, after;
  Localisation localisation;
  std::vector<Finalist> finalists;  ///< best first
  /// Where names cannot be told apart: the fit with the effects, then one for each rival in place
  /// of what it cannot be told from, where it was fitted.
  std::vector<Fit> rivals;
  std::vector<Detectable> detectability;
  ExcessError gap;  ///< on the trials that were fitted
  std::optional<ExcessError> heldOut;
  std::optional<HeldOutAdequacy> heldOutBefore, heldOutAfter;
  std::optional<Unknown> unknown;
  /// Where all terms of its formula follow the state and the data offer it (withFormula)
  std::optional<RacedFormula> formula;
  /// Where something is missing, and the data offer it (withFormula)
  std::optional<NonparametricForce> nonparametric;
  double numericalError = 0;  ///< largest change at half the time step, in σ_y; 0: not offered
  int fits = 0;               ///< how many
};

/// The hypotheses that a search has fitted, for a search of the same data at another time step to
/// start from.
struct SearchMemory;
using WarmStart = std::shared_ptr<const SearchMemory>;

/// Finds, names and judges what a model lacks.
/// @param draft  if not null and not empty: starts from there; if not null, left as the search is
///   after its race
/// @throws std::invalid_argument if the data break a rule of DiscoveryProblem
Verdict run(const DiscoveryProblem& data, const Options& options = {}, WarmStart* draft = nullptr);

/// Standard deviation of a trial's measurements about the simulation with the effects, at its
/// times: √(σ_y² + Σ (dy/dA·σ_A)²) over the amplitudes A, each by itself.
/// @throws what DiscoveryProblem::predict throws
Eigen::VectorXd predictedSd(const DiscoveryProblem& data, const Verdict& verdict, int trial);

const char* name(Finding finding);
const char* name(Stage stage);
const char* name(EffectKind kind);
const char* name(NonparametricForce::Follows follows);

}  // namespace info::discover
