#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/trial_set.h"
#include "info/bootstrap.h"
#include "info/determinacy.h"
#include "info/multi_start.h"
#include "info/profile_likelihood.h"

namespace bio {

struct CalibrationOptions {
  TrialSetOptions trials;
  bool priors = true;  ///< the catalogue's deviations about the model's values; else bounds alone
  std::map<std::string, info::GaussianPrior> prior;         ///< instead of the catalogue's, by name
  std::map<std::string, std::pair<double, double>> bounds;  ///< likewise
  /// Standard deviation of the measured angles [rad] > 0, white; nothing: from the residuals.
  std::optional<double> noise;
  info::RobustLoss loss;
  int starts = 1;
  std::uint64_t seed = 1;
  double confidence = 0.95;          ///< of all intervals, in (0, 1)
  std::vector<std::string> profile;  ///< parameters whose profile likelihood is computed
  int bootstrap = 0;                 ///< replicates; 0: none
  /// Called with the share of the work done, 0 to 1; returning false stops. From any thread.
  std::function<bool(double)> progress = {};
};

struct CalibratedParameter {
  info::Parameter asked;  ///< start, bounds, prior
  double model = 0;       ///< as the model has it
  double known = 0;       ///< standard deviation of what was known beforehand
  bool ofTrial = false;   ///< start of one trial, not a parameter of the model
  double value = 0;
  bool identifiable = false;
  bool atBound = false;
  /// Standard deviation and interval from the Fisher matrix at the estimate, priors included; NaN
  /// where not identifiable or on a bound.
  double deviation, lower, upper;
  info::Determinacy determinacy;  ///< what the data alone say
  std::string why;                ///< there is no interval, in words; else empty
  std::optional<info::ProfileInterval> profile;
  /// Of the bootstrap; NaN without it, and where there is no interval.
  double bootstrapDeviation, bootstrapLower, bootstrapUpper;
};

/// What is known of the noise on the angles.
struct ResidualNoise {
  double deviation = 0;        ///< of one sample [rad]: given, or that of the residuals
  double correlationTime = 1;  ///< samples per independent value; 1 where the noise was given
  double effective = 0;        ///< deviation·√correlationTime, what the fit weighs with [rad]
  std::vector<double> autocorrelation;  ///< of the residuals, at lags 0, 1, … samples
};

struct Calibration {
  std::string failure;  ///< why there is nothing to estimate from; all else is then empty
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< of all parameters' estimates; 0 beside one on a bound
  info::Termination why;
  bool converged = false;
  int iterations = 0, evaluations = 0;
  std::vector<info::StartOutcome> starts;
  int agreeingStarts = 0;
  int bootstrapConverged = 0;
  bool complete = true;  ///< false if the progress callback stopped it
  ResidualNoise noise;
  double noiseFloor = 0;        ///< what third differences of the measured angles have of it [rad]
  /// The residuals are half as large again as the scatter of neighbouring samples: something else
  /// than these parameters is wrong.
  bool leavesMoreThanNoise() const {
    return noiseFloor > 0 && noise.deviation > 1.5 * noiseFloor;
  }
  double reducedChiSquare = 0;  ///< of single samples; near 1 where the noise is what was said
  Eigen::MatrixXd before, after;  ///< of the trials estimated from, 1 × samples [rad]
  Eigen::MatrixXd heldOutBefore, heldOutAfter;  ///< of the others
  /// The model, the EMG mapping and the first trial's start at the estimate.
  std::optional<ParameterCatalogue::Setting> calibrated;
};

/// Estimates parameters of a model from measured motions.
///
/// Minimises ½Σρ(r²/σ²) + ½Σ(θ − μ)²/d² within bounds by Levenberg–Marquardt with exact
/// sensitivities (estimate.h). A parameter value at which a trial cannot be simulated is a step not
/// taken.
///
/// Where no noise is given, σ is found together with θ: σ² = Σr²/(n − p) (with a robust loss
/// 1.4826·median|r|), times the number of samples τ that the residuals' autocorrelation makes of
/// one independent value. A model that does not fit leaves slow residuals, and τ keeps a thousand
/// of them from counting as a thousand measurements.
///
/// Intervals are given for what the data themselves determine (determinacy.h), with priors added;
/// of all else the reason is given in words. A parameter on a bound is held there for the others'
/// intervals; one without effect on any angle, and without prior, stays as the model has it. Trials
/// held out are simulated from their own first measured value, at rest.
///
/// @throws std::invalid_argument what TrialSet throws, and for an option out of range, a prior or
///   bound of a parameter that is not estimated, bounds that do not enclose the start
Calibration calibrate(const TrialSet& training, const TrialSet* heldOut,
                      const CalibrationOptions& options);

}  // namespace bio
