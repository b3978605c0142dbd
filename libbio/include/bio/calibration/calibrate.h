#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/calibration/trial_set.h"
#include "info/estimation/bootstrap.h"
#include "info/estimation/multi_start.h"
#include "info/estimation/profile_likelihood.h"
#include "info/information/determinacy.h"

namespace bio {

struct Calibration;

struct CalibrationOptions {
  TrialSetOptions trials;
  bool priors = true;  ///< true: default priors about the model's values; false: bounds only
  std::map<std::string, info::GaussianPrior> prior;  ///< instead of the default priors, by name
  std::map<std::string, std::pair<double, double>> bounds;  ///< likewise
  /// Standard deviation of the white noise of the measured angles [rad] > 0; empty: estimated from
  /// the residuals.
  std::optional<double> noise;
  /// Standard deviations of the noise of other channels, by column name, in their units [> 0].
  std::map<std::string, double> channelNoise = {};
  info::RobustLoss loss;
  int starts = 1;
  std::uint64_t seed = 1;
  double confidence = 0.95;          ///< of all intervals, in (0, 1)
  std::vector<std::string> profile;  ///< parameters whose profile likelihood is computed
  int bootstrap = 0;                 ///< replicates; 0: none
  /// Start of the search, in place of the model's values: all estimated numbers, in their order.
  /// No other starts are led then.
  std::optional<Eigen::VectorXd> from = {};
  /// With `from`: where else minima are looked for, as Calibration::candidates has them.
  std::vector<Eigen::VectorXd> candidates = {};
  /// Called from any thread with the fraction of the work done, 0 to 1; returning false stops.
  std::function<bool(double)> progress = {};
  /// Called with an estimate and its intervals; returning false ends without profiles and
  /// replicates. Empty: true.
  std::function<bool(const Calibration&)> isFinal = {};
};

struct CalibratedParameter {
  info::Parameter asked;   ///< start, bounds, prior
  ParameterTarget target;  ///< what it sets; of several targets the first
  double model = 0;        ///< value in the model
  double priorSd = 0;      ///< prior standard deviation
  bool ofTrial = false;    ///< initial state of one trial, not a parameter of the model
  double value = 0;
  bool identifiable = false;
  bool atBound = false;
  /// Standard deviation and interval from the Fisher matrix at the estimate, priors included; NaN
  /// if not identifiable or at a bound. Where the cost at the ends of the interval contradicts it,
  /// the ends are those of the profile likelihood. With another minimum the interval encloses both,
  /// and there is no standard deviation.
  double sd, lower, upper;
  bool byLikelihood = false;      ///< the interval is that of the profile likelihood
  info::Determinacy determinacy;  ///< identifiability from the data alone
  std::string why;  ///< why there is no interval, or one that encloses other minima; else empty
  std::optional<info::ProfileInterval> profile;
  /// From the bootstrap; NaN without bootstrap or interval.
  double bootstrapSd, bootstrapLower, bootstrapUpper;
};

/// Noise of a measured channel.
struct ResidualNoise {
  double sd = 0;  ///< standard deviation of one sample [rad, or the channel's unit]: given, or that
                  ///< of the residuals
  double correlationTime = 1;           ///< samples per independent value; 1 if the noise was given
  double effective = 0;                 ///< deviation·√correlationTime, the sd used by the fit
  std::vector<double> autocorrelation;  ///< of the residuals, at lags 0, 1, … samples
};

/// Another minimum of the cost, three standard deviations from the estimate or more, which the data
/// and priors leave possible (Δ ≤ 4.6 nats: e^{−Δ} ≥ 1 % as likely, its width taken to be the same)
/// or the data alone (1.92 nats: inside a 95 % interval of their likelihood).
struct OtherMinimum {
  Eigen::VectorXd values;         ///< of all estimated numbers
  Eigen::VectorXd sd = {};        ///< their standard deviations there
  double difference = 0;          ///< Δ of the cost [nats]
  double ofData = 0;              ///< of it without the priors [nats]; < 0: it fits better
  bool isLikely() const;          ///< Δ ≤ 4.6 nats
  bool isPossibleByData() const;  ///< Δ of the data ≤ 1.92 nats
};

struct Calibration {
  std::string failure;  ///< why no estimate is possible; all other members are then empty
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of all estimates; 0 for a parameter at a bound
  info::Termination why;
  bool converged = false;
  int iterations = 0, evaluations = 0;
  std::vector<info::StartOutcome> starts;
  int agreeingStarts = 0;
  std::vector<OtherMinimum> otherMinima;  ///< that other starts found; the likeliest first
  /// Ends of searches up to 20 nats above the estimate, to go on from with other steps or noise.
  std::vector<Eigen::VectorXd> candidates;
  int bootstrapConverged = 0;
  std::vector<std::string> remarks = {};    ///< what was asked for beside the estimates and failed
  bool complete = true;                     ///< false if the progress callback stopped it
  ResidualNoise noise;                      ///< of the first of the set's channels
  std::vector<ResidualNoise> channelNoise;  ///< of all of them, in that order
  double noiseFloor = 0;           ///< noise from third differences of the measured angles [rad]
  Eigen::VectorXd values() const;  ///< of all estimated numbers
  /// Whether the residuals exceed the scatter of neighbouring samples by half: then other
  /// parameters or effects are wrong, too.
  bool leavesMoreThanNoise() const { return noiseFloor > 0 && noise.sd > 1.5 * noiseFloor; }
  double reducedChiSquare = 0;    ///< of single samples; near 1 if the noise was given correctly
  Eigen::MatrixXd before, after;  ///< of the calibration trials, 1 × samples
  Eigen::MatrixXd heldOutBefore, heldOutAfter;  ///< of the others
  /// Standard deviation of heldOutAfter from that of the common estimates, √(Γ Σ Γᵀ); priors are in
  /// Σ, noise is not.
  Eigen::VectorXd heldOutSd;
  /// All numbers of the held-out trials: those estimated, and their own starts, if they have such.
  Eigen::VectorXd heldOutValues;
  /// The model, the EMG mapping and the first trial's initial state at the estimate.
  std::optional<ParameterCatalogue::Setting> calibrated;
};

/// Estimates parameters of a model from measured motions.
///
/// Minimises ½Σρ(r²/σ²) + ½Σ(θ − μ)²/d² within bounds by Levenberg–Marquardt with exact
/// sensitivities (estimate.h). A step to parameters at which a trial cannot be simulated is
/// rejected.
///
/// Each measured channel has a noise of its own: all angles are one channel. If no noise is given,
/// σ is estimated together with θ, of several channels by turns: σ² = Σr²/(n − p), p shared among
/// them by their numbers of samples (with a robust loss σ =
/// 1.4826·median|r|), multiplied by the number τ of samples per independent value, from the
/// autocorrelation of the residuals. A model that does not fit has slowly varying residuals;
/// without τ a thousand of them would count as a thousand measurements.
///
/// Intervals, with priors included, are given for parameters that the data determine
/// (determinacy.h); for the others the reason is given in words. The Fisher matrix claims that the
/// cost rises by z²/2 nats at the ends of an interval. If it rises by less than 0.7 or more
/// than 1.4 of that at either end, the interval is that of the profile likelihood; where the search
/// has not converged either, e.g. since paths jump, there is none. An interval encloses other
/// minima (OtherMinimum), which are looked for from all starts and from mirrored path points. A
/// parameter at a bound is held there for the intervals of the others; one without effect on any
/// angle and without prior keeps the model's value. Held-out trials are simulated from their own
/// first measured value, at rest; if their set has own starts (TrialSetOptions::ownStart), these
/// are estimated from each of them with the parameters fixed.
///
/// @throws std::invalid_argument what TrialSet throws, and for an option out of range, a prior or
///   bound of a parameter that is not estimated, bounds that do not enclose the start
Calibration calibrate(const TrialSet& training, const TrialSet* heldOut,
                      const CalibrationOptions& options);

}  // namespace bio
