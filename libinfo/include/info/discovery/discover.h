#pragma once

#include <Eigen/Dense>
#include <cmath>
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
#include "info/discovery/likelihood/whitening.h"
#include "info/discovery/nonparametric/unknown.h"

namespace info::discover {

/// The kinds of verdict.
enum class Finding {
  none,       ///< no effect larger than Verdict::detectability is missing
  parameter,  ///< a parameter of the base model is in error beyond its tolerance
  named,      ///< one effect, or several together, each without an alternative
  ambiguous,  ///< one of several effects that these data cannot distinguish
  unknown,    ///< an effect is missing that the catalogue does not explain
  numerical,  ///< the base model's time step is too long for a conclusion
};

enum class Stage { calibrate, localise, screen, race, decide, finished };

struct Progress {
  Stage stage = Stage::calibrate;
  double fraction = 0;  ///< of the total, 0 to 1
  std::string doing;    ///< e.g. "race: visc"
};

struct Options {
  /// σ_y of each output [its unit]; empty: estimated from the data's third differences
  std::optional<Whitening> sds;
  double latentTime = 0.08;        ///< ℓ [s] of the latent force
  double latentScale = 0.02;       ///< s of the prior exp(−σ_d/s), which favours σ_d = 0
  double latentTolerance = 0.075;  ///< largest σ_d that noise of the inputs may explain
  double evidence =
      5;  ///< log Bayes factor [nats] that an effect needs over the hypothesis without it
  double significance = 3.5;  ///< standard deviations by which its amplitude must differ from 0
  double remainder = 3;       ///< largest log Bayes factor [nats] of a further disturbance with a
                              ///< Cause, or of a non-parametric force, that is tolerated
  double classWidth = 4.6;    ///< [nats] alternatives at most so far behind stay in the class
  double largestPriorZ = 3;   ///< prior standard deviations beyond which a parameter is in error
  double level = 0.001;       ///< significance level of every test of adequacy
  double falseDiscoveries = 0.05;  ///< false discovery rate of the score map
  int maxEffects = 3;
  int finalists = 9;         ///< largest number of candidates fitted at a time
  std::vector<int> heldOut;  ///< trials that are used for validation only
  /// Largest change of the outputs at half the time step [σ_y]; beyond it the finding is
  /// `numerical`.
  double numericalTolerance = 0.2;
  /// Whether a verdict `numerical` has the effects that were found with this time step.
  bool concludesNumerical = true;
  bool judgeSamples = true;  ///< exclude outliers, and samples with correlated noise
  bool symbolic = true;      ///< search a formula if no effect of the catalogue fits
  /// runAtShorterSteps: if the fitted trials show nothing and errors as large as those of the
  /// held-out trials are less probable than this, the search is repeated with the held-out trials
  /// fitted as well; 0: never
  double secondLook = 0.05;
  /// If errors as large as those of the held-out trials are less probable than this, the verdict
  /// says so and gives no probability of an effect.
  double farOff = 0.01;
  /// If the error expected of the held-out trials, from the noise and the uncertainty of what was
  /// fitted, is larger than this many standard deviations of the noise, their agreement confirms
  /// nothing: the verdict says so and gives no probability of an effect.
  double vague = 3;
  /// Smallest share of the excess squared error that effects must explain in simulation to be
  /// named.
  double leastExplained = 0.05;
  /// Share of the excess squared error of the held-out trials from which effects are named, without
  /// a probability, although the residual is not the noise that the tests of adequacy assume.
  double carriesOver = 0.95;
  /// If the mean square of the innovations with the effects found is smaller than this, an
  /// estimated σ_y is reduced accordingly and the search repeated, twice at most; 0: never.
  double overestimated = 0.5;
  /// Called between fits; returning false ends the search, and the verdict holds the results so
  /// far.
  std::function<bool(const Progress&)> progress;
  /// Asked before every simulation, so it must be cheap: false ends the search as progress does.
  /// May be empty. Not asked in fits of formulas, which come last.
  std::function<bool()> goOn;
};

/// The estimate of one quantity in a hypothesis.
struct Estimate {
  std::size_t quantity = 0;  ///< index into DiscoveryProblem::quantities()
  double value = 0;
  double sd = 0;         ///< posterior standard deviation, in the unit of the quantity
  double priorZ = 0;     ///< (value − nominal)/prior standard deviation; of the logarithm if the
                         ///< prior is log-normal
  bool atBound = false;  ///< within 1e-6 of its range of a bound
  /// RMS change of the fitted trials' outputs between its nominal value and this one, linear in its
  /// coordinate [σ of the outputs]; NaN: not computed
  double moves = NAN;
};

/// A hypothesis that was fitted and compared.
struct Finalist {
  std::vector<std::size_t> effects;  ///< indices into DiscoveryProblem::candidates()
  double logEvidence = 0;  ///< log Z − log Z of the base model [nats], each at its own optimal σ_d
  double latentSize = 0;    ///< that σ_d
  double probability = 0;   ///< among all fitted hypotheses with at most as many effects
  double significance = 0;  ///< smallest |amplitude − nominal|/standard deviation
  bool adequate = false;    ///< for the leader and its alternatives; the others are not tested
  std::vector<Estimate> estimates;  ///< of the effects' quantities
};

/// An effect that the verdict names as missing, and the effects that cannot be distinguished from
/// it.
struct NamedEffect {
  std::size_t candidate = 0;
  std::vector<Estimate> estimates;  ///< of its quantities, the amplitude first
  double logBayesFactor = 0;        ///< log Bayes factor [nats] against the hypothesis without it
  /// Probability of this effect against the alternatives in its place; NaN for a proxy.
  double probability = 0;
  std::vector<std::size_t> equals;    ///< candidates in its class, itself first
  std::vector<double> equalEvidence;  ///< their log Z relative to that of the leader
  bool exact = false;                 ///< true: some of them are equivalent by declaration
};

/// The smallest detectable amplitude of a candidate in these data, 5/√S_cc.
struct Detectable {
  std::size_t candidate = 0;
  double amplitude = 0;  ///< [unit of the amplitude]; infinite: undetectable
};

struct Verdict;

/// Comparison of the fitted formula of an unknown effect (Unknown) with the proxy effects. The
/// formula does not identify an effect; it describes the shape of the force.
struct RacedFormula {
  bool wins = false;  ///< as a candidate it would have been the verdict, without an alternative
  double logBayesFactor = 0;  ///< log Bayes factor [nats] against the base model
  double significance = 0;    ///< |c|/deviation, for given r_k
  std::size_t axis = 0;       ///< on which the force acts
  std::vector<FormulaTerm> terms;
  std::string text;            ///< with values, e.g. "-1.48·(q³ - 3.6·q²)"
  std::vector<double> values;  ///< c, then r_2, … (FormulaTerm)
  std::vector<double> sds;
  Adequacy after;      ///< of the innovations, with the formula
  ExcessError excess;  ///< on the fitted trials
  std::optional<ExcessError> heldOut;
  /// If it wins: the data with the formula as a candidate, and the verdict with it.
  std::shared_ptr<const DiscoveryProblem> data;
  std::shared_ptr<const Verdict> verdict;
};

/// A non-parametric force on one axis, a smooth function of its position or of its speed alone, and
/// its comparison with the effects of the catalogue (docs/decisions/047-nonparametric-forces.md):
/// the one that is furthest ahead over all axes.
struct NonparametricForce {
  enum class Follows { position, speed };
  std::size_t axis = 0;  ///< on which it acts, and whose position or speed it follows
  Follows follows = Follows::position;
  std::vector<std::size_t> besides;  ///< effects that remain in the model beside it: candidates
  double logBayesFactor =
      0;  ///< log Bayes factor [nats] against the base model, together with those
  /// Log Bayes factor [nats] against the named effects, or against the base model if there are
  /// none, less Options::evidence for each effect.
  double ahead = 0;
  bool wins = false;       ///< by more than Options::remainder: the named effects are only a proxy
  std::vector<double> at;  ///< visited positions or speeds [unit of the axis, or of its rate]
  Eigen::VectorXd force;   ///< the force at these [unit of the generalised force]
  Eigen::VectorXd sd;      ///< of that
};

/// The effects of a verdict looked for in the held-out trials alone, with all nuisance parameters
/// fitted anew (docs/decisions/067-replication.md).
struct Replication {
  double logBayesFactor = 0;        ///< log Bayes factor [nats] there against the base model
  std::vector<Estimate> estimates;  ///< of the effects' quantities there
  /// Each effect has the evidence there that it needed in the fitted trials, and its amplitudes
  /// agree within 2 standard deviations of their difference.
  bool replicated = false;
};

/// The result of a search. Everything up to `reached` is filled in; for a search that was stopped
/// after the fit of the base model also the localisation and the finalists so far.
struct Verdict {
  Stage reached = Stage::calibrate;
  Finding finding = Finding::none;
  std::string sentence;              ///< the finding as a sentence
  std::vector<NamedEffect> effects;  ///< in the order they were found; for unknown: the proxy
  double probability = 0;            ///< of all effects together; 0 if none is given
  /// Effects are named, but without a probability: the innovations have the wrong size, the errors
  /// of the held-out trials are improbably large (Options::farOff), no agreement with them would
  /// confirm anything (Options::vague), what is left is not noise (remainder), or these trials show
  /// the effects only with parameters of their own (Replication).
  bool vetoed = false;
  /// Where effects are named because they carry over to the held-out trials
  /// (Options::carriesOver), though the residual of the fitted trials is not noise: the force that
  /// is left.
  std::optional<RemainingForce> remainder;
  bool surrogate = false;  ///< finding unknown: `effects` is only a proxy for the missing effect
  /// Nothing was found without the held-out trials, although their errors were too large. All
  /// trials were therefore fitted, and none is left for validation (Options::secondLook).
  bool heldOutFitted = false;

  Whitening sds;  ///< σ_y of each output
  bool sdEstimated = false;
  RecordedNoise noise;                   ///< the samples that were used, and why others were not
  double latentSizeBefore = 0;           ///< σ_d with the base model
  double latentSizeAfter = 0;            ///< σ_d with the effects
  Eigen::VectorXd base;                  ///< all quantities of the calibrated base model
  Eigen::VectorXd values;                ///< all quantities with the effects
  std::vector<Estimate> calibration;     ///< nuisances of the base model
  std::vector<Estimate> nuisancesAfter;  ///< with the effects
  /// Initial states of the held-out trials, each fitted to its trial alone, with the effects; the
  /// values are in `values`, and those without the effects in `base`.
  std::vector<Estimate> heldOutStarts;
  Adequacy before, after;
  Localisation localisation;
  std::vector<Finalist> finalists;  ///< best first
  /// For indistinguishable effects: the fit with the effects, then a fit for each fitted
  /// alternative in place of the effect that it cannot be distinguished from.
  std::vector<Fit> rivals;
  std::vector<Detectable> detectability;
  ExcessError excess;  ///< on the trials that were fitted
  std::optional<ExcessError> heldOut;
  std::optional<HeldOutAdequacy> heldOutBefore, heldOutAfter;
  /// If effects were chosen, but the held-out trials are not as expected with them.
  std::optional<Replication> replication;
  std::optional<Unknown> unknown;
  /// If all terms of its formula are functions of the state and the problem offers it (withFormula)
  std::optional<RacedFormula> formula;
  /// If an effect is missing and the problem offers it (withFormula)
  std::optional<NonparametricForce> nonparametric;
  double numericalError = 0;  ///< largest change at half the time step, in σ_y; 0: not available
  int fits = 0;               ///< how many
};

/// Whether the effects of a verdict may be built into the model. Proxies may not: they would hide
/// the unknown effect.
inline bool mayBeAdded(const Verdict& verdict) {
  return verdict.reached == Stage::finished && !verdict.surrogate && !verdict.effects.empty() &&
         verdict.finding != Finding::numerical;
}

/// The fitted hypotheses of a search, as the starting point of a search of the same data at another
/// time step.
struct SearchMemory;
using WarmStart = std::shared_ptr<const SearchMemory>;

/// Finds and names the effects that are missing in a model, and judges the result.
/// @param draft if not null and not empty: the starting point; if not null, receives the state of
///   the search after all fits
/// @throws std::invalid_argument if the data break a rule of DiscoveryProblem
Verdict run(const DiscoveryProblem& data, const Options& options = {}, WarmStart* draft = nullptr);

/// The verdict where no search makes sense, since the recording is in error: `unknown`, with the
/// noise of the recording and the errors of the nominal model. Nothing but initial states is
/// fitted.
/// @throws as run()
Verdict withoutSearch(const DiscoveryProblem& data, const Options& options);

/// Standard deviation of a trial's measurements about the simulation with the effects, at its
/// times: √(σ_y² + Σ (dy/dA·σ_A)²), the sum being over the amplitudes A without their correlations.
/// @throws what DiscoveryProblem::predict throws
Eigen::VectorXd predictedSd(const DiscoveryProblem& data, const Verdict& verdict, int trial);

const char* name(Finding finding);
const char* name(Stage stage);
const char* name(EffectKind kind);
const char* name(NonparametricForce::Follows follows);

}  // namespace info::discover
