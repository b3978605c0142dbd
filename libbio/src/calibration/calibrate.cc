#include "bio/calibration/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibration/asked_parameters.h"
#include "calibration/channel_noise.h"
#include "calibration/checked_intervals.h"
#include "calibration/held_out_starts.h"
#include "calibration/judgement.h"
#include "calibration/like_paths.h"
#include "calibration/nudged_starts.h"
#include "calibration/other_minima.h"
#include "info/estimation/monte_carlo.h"
#include "info/estimation/residuals.h"

namespace bio {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Noise and estimate follow each other until σ changes by less than this share.
constexpr double noiseSettled = 0.01;
constexpr int noiseRounds = 12;

class Calibrator {
 public:
  Calibrator(const TrialSet& training, const TrialSet* heldOut, const CalibrationOptions& options)
      : training_(training),
        heldOut_(heldOut),
        options_(options),
        predictor_(training.predictor()),
        measured_(training.measured()),
        channels_(training, options) {
    requireValid(options);
    AskedParameters asked = askedParameters(training, heldOut, options);
    asked_ = std::move(asked.parameters);
    priorSds_ = std::move(asked.priorSds);
    for (const std::string& name : options_.profile) {
      profiled_.push_back(placeOfParameter(training, name, "profile"));
    }
    result_.why = info::Termination::stopped;
  }

  Calibration run() {
    const VectorXd asIs = valuesOf(training_.parameters()), start = valuesOf(asked_);
    result_.before = predictor_.outputs(asIs);
    if (heldOut_) {
      VectorXd values = valuesOf(heldOut_->parameters());
      values.head(common()) = asIs.head(common());
      result_.heldOutBefore = heldOut_->predictor().outputs(values);
    }
    atStart_ = start == asIs ? result_.before : predictor_.outputs(start);
    if (!atStart_.allFinite() && options_.starts == 1) {
      result_.failure = failureAt(start);
      return result_;
    }
    if (atStart_.allFinite()) holdWhatHasNoEffect(start);
    try {
      fit();
    } catch (const std::domain_error& error) {
      result_.failure = error.what();
      if (!atStart_.allFinite()) result_.failure += fmt::format(" ({})", failureAt(start));
      return result_;
    }
    judge();
    if (result_.complete && options_.isFinal && !options_.isFinal(result_)) return result_;
    if (result_.complete) refineIntervals();
    if (result_.complete) profiles();
    if (result_.complete && options_.bootstrap > 0) resample();
    return std::move(result_);
  }

 private:
  Index common() const { return static_cast<Index>(training_.numCommon()); }

  static VectorXd valuesOf(const std::vector<info::Parameter>& parameters) {
    VectorXd values(static_cast<Index>(parameters.size()));
    for (Index i = 0; i < values.size(); ++i) {
      values[i] = parameters[static_cast<std::size_t>(i)].start;
    }
    return values;
  }

  std::string failureAt(const VectorXd& theta) const {
    for (std::size_t i = 0; i < training_.trials().size(); ++i) {
      const std::string why = training_.failure(i, theta);
      if (!why.empty()) {
        return fmt::format("{}: the simulation fails at the start values: {}",
                           training_.trials()[i].file, why);
      }
    }
    return "the simulation at the start values shows no finite value";
  }

  /// false: stop
  bool progress(double share) {
    if (!options_.progress || options_.progress(share)) return true;
    result_.complete = false;
    return false;
  }

  double shareOfFit() const {
    return options_.profile.empty() && options_.bootstrap == 0 ? 1.0 : 0.3;
  }

  /// A parameter that changes no measured angle, and has no prior, stays where it is.
  void holdWhatHasNoEffect(const VectorXd& start) {
    const MatrixXd gamma = predictor_.withSensitivities(start).gamma;
    for (Index i = 0; i < gamma.cols(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!asked_[k].prior && (gamma.col(i).array() == 0).all()) held_.push_back(k);
    }
  }

  info::LeastSquares problem(double sigma) const {
    const info::OutputCovariance covariance(MatrixXd::Constant(1, 1, sigma * sigma));
    std::vector<info::Parameter> parameters = asked_;
    for (const std::size_t i : held_) parameters[i].lower = parameters[i].upper = asked_[i].start;
    return {channels_.weighted(predictor_),
            {channels_.weighted(measured_), covariance, {}, options_.loss},
            parameters};
  }

  info::EstimateOptions estimateOptions() {
    info::EstimateOptions estimate;
    // statistically nothing: a ten-thousandth of a deviation, a millionth of a nat
    estimate.gradientTolerance = 1e-4;
    estimate.decrementTolerance = 1e-6;
    // paths that lift off and fibres that turn put kinks into the motion's dependence on θ
    estimate.kinkTolerance = 0.01;
    estimate.confidence = options_.confidence;
    return estimate;
  }

  void setNoise(std::vector<ResidualNoise> noises) {
    channels_.weigh(noises);
    result_.noise = noises.front();
    result_.channelNoise = std::move(noises);
  }

  Index numPriors() const {
    return std::count_if(asked_.begin(), asked_.end(), [](const auto& p) { return !!p.prior; });
  }

  /// Squares of residuals in deviations of one sample, per degree of freedom.
  double chiSquare() const {
    const Index fitted = std::max<Index>(0, static_cast<Index>(asked_.size()) - numPriors());
    const double freedom = static_cast<double>(std::max<Index>(1, measured_.size() - fitted));
    if (channels_.areOne()) {
      return (measured_ - result_.after).squaredNorm() /
             (result_.noise.sd * result_.noise.sd * freedom);
    }
    double sum = 0;
    for (std::size_t channel = 0; channel < result_.channelNoise.size(); ++channel) {
      for (const VectorXd& r : channels_.residuals(result_.after, channel)) {
        sum += (r / result_.channelNoise[channel].sd).squaredNorm();
      }
    }
    return sum / freedom;
  }

  void fit() {
    double done = 0;
    info::EstimateOptions estimate = estimateOptions();
    estimate.progress = [&](const info::EstimateProgress&) {
      done += 0.15 * (1 - done);
      return progress(shareOfFit() * done);
    };
    const auto p = static_cast<Index>(asked_.size());
    for (std::size_t i = 0; i < training_.channels().size(); ++i)
      if (training_.channels()[i].areAngles) result_.noiseFloor = measuredSd(training_, i);
    const std::vector<VectorXd> nudged =
        options_.from ? std::vector<VectorXd>() : nudgedFrom(valuesOf(asked_), estimate);
    const MatrixXd guess = best(nudged);
    std::vector<ResidualNoise> first = channels_.of(guess, 0);
    for (ResidualNoise& noise : first) noise.effective = noise.sd;  // white until there is a fit
    setNoise(std::move(first));
    {
      const info::MultiStart found = info::estimateFromStarts(
          problem(result_.noise.effective), priorSds_,
          {options_.starts, options_.seed, options_.trials.threads, 2, estimate, nudged});
      estimate_ = found.best;
      result_.starts = found.outcomes;
      result_.agreeingStarts = found.agreeing;
    }
    result_.iterations = estimate_.iterations;
    result_.evaluations = estimate_.evaluations;
    for (int round = 0; round < noiseRounds && result_.complete; ++round) {
      const std::vector<ResidualNoise> before = result_.channelNoise;
      result_.after = predictor_.outputs(estimate_.parameters);
      setNoise(channels_.of(result_.after, std::max<Index>(0, p - numPriors())));
      bool isSettled = true;
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double change = result_.channelNoise[i].effective - before[i].effective;
        isSettled = isSettled && std::abs(change) <= noiseSettled * before[i].effective;
      }
      // also where it is settled: the cost that profiles compare with is that of this noise
      auto again =
          info::estimateIfDefined(problem(result_.noise.effective), estimate_.parameters, estimate);
      if (!again) break;
      estimate_ = std::move(*again);
      result_.iterations += estimate_.iterations;
      result_.evaluations += estimate_.evaluations;
      if (isSettled) break;
    }
    if (result_.complete) lookForOtherMinima(estimate);
    if (result_.complete) {
      const int iterations = estimate_.iterations, evaluations = estimate_.evaluations;
      estimate_ =
          betterBeside(problem(result_.noise.effective), std::move(estimate_), common(), estimate);
      result_.iterations += estimate_.iterations - iterations;
      result_.evaluations += estimate_.evaluations - evaluations;
    }
    result_.why = estimate_.why;
    result_.converged = estimate_.converged;
    result_.after = predictor_.outputs(estimate_.parameters);
    result_.reducedChiSquare = chiSquare();
    if (heldOut_) {
      result_.heldOutValues =
          valuesOfHeldOut(*heldOut_, estimate_.parameters.head(common()), training_,
                          result_.channelNoise, options_, estimateOptions());
      result_.heldOutAfter = heldOut_->predictor().outputs(result_.heldOutValues);
    }
    result_.calibrated =
        training_.catalogue().at(training_.selection(), estimate_.parameters.head(common()));
  }

  /// One that is better becomes the estimate.
  void lookForOtherMinima(const info::EstimateOptions& options) {
    const info::LeastSquares least = problem(result_.noise.effective);
    std::vector<info::StartOutcome> ends = result_.starts;
    std::vector<VectorXd> further = options_.candidates;
    if (!options_.from) {
      further = startsAtLikePaths(training_, least.parameters(), estimate_.parameters);
      const double sd = channels_.areOne() ? channels_.shown().front().sd : result_.noise.effective;
      const auto nudged =
          nudgedStarts(training_, channels_, least.parameters(), further, sd, options);
      further.insert(further.end(), nudged.begin(), nudged.end());
    }
    for (const VectorXd& start : further) {
      const auto end = info::estimateIfDefined(least, start, options);
      if (!end) continue;
      result_.iterations += end->iterations;
      result_.evaluations += end->evaluations;
      ends.push_back({start, end->parameters, end->cost, end->converged, info::describe(end->why)});
    }
    OtherMinima found = otherMinima(least, ends, priorSds_, common(), estimate_, options);
    result_.iterations += found.iterations;
    result_.evaluations += found.evaluations;
    estimate_ = std::move(found.best);
    result_.otherMinima = std::move(found.others);
    result_.candidates = std::move(found.candidates);
  }

  /// Where further starts end that are led by held models; none where nothing is to be led.
  std::vector<VectorXd> nudgedFrom(const VectorXd& start, const info::EstimateOptions& estimate) {
    const std::vector<ResidualNoise> shown = channels_.shown();
    channels_.weigh(shown);
    const double sd = shown.front().sd;
    const std::vector<info::Parameter> parameters = problem(sd).parameters();
    const std::vector<VectorXd> starts = startsOnBothSides(training_, parameters, start);
    std::vector<VectorXd> nudged =
        nudgedStarts(training_, channels_, parameters, starts, sd, estimate);
    return nudged.empty() ? starts : nudged;
  }

  /// The prediction nearest to the data, of the start and of those.
  MatrixXd best(const std::vector<VectorXd>& starts) const {
    MatrixXd nearest =
        atStart_.allFinite() ? atStart_ : MatrixXd::Constant(1, measured_.size(), measured_.mean());
    for (const VectorXd& start : starts) {
      const MatrixXd there = predictor_.outputs(start);
      if (channels_.distance(there) < channels_.distance(nearest)) nearest = there;
    }
    return nearest;
  }

  /// Judges the estimates: their uncertainty, and that of held-out predictions.
  void judge() {
    const info::Prediction at =
        channels_.weighted(predictor_).withSensitivities(estimate_.parameters);
    const double sigma = result_.noise.effective;
    const VectorXd white = (channels_.weighted(measured_) - at.outputs).transpose() / sigma;
    // a robust loss makes less of normal noise; scale by what it makes of these residuals
    const double widening =
        options_.loss.kind == info::RobustLoss::Kind::gaussian
            ? 1.0
            : info::varianceFactor(options_.loss, white * std::sqrt(result_.noise.correlationTime));
    const MatrixXd data = at.gamma.transpose() * at.gamma / (sigma * sigma * widening);
    Judgement judgement =
        judged({asked_, priorSds_}, training_, estimate_.parameters, data, options_.confidence);
    result_.parameters = std::move(judgement.parameters);
    covariance_ = judgement.covariance;
    result_.correlation = std::move(judgement.correlation);
    if (heldOut_) {
      result_.heldOutSd = predictionSd(*heldOut_, result_.heldOutValues,
                                       judgement.covariance.topLeftCorner(common(), common()));
    }
  }

  /// By the cost itself, and by the other minima.
  void refineIntervals() {
    if (options_.loss.kind == info::RobustLoss::Kind::gaussian) {  // else a nat is none of the cost
      info::EstimateOptions options = estimateOptions();
      options.progress = [&](const info::EstimateProgress&) { return progress(shareOfFit()); };
      checkIntervals(problem(result_.noise.effective), estimate_, covariance_, common(), options,
                     result_.parameters);
    }
    encloseMinima(result_.otherMinima, common(), options_.confidence, result_.parameters);
  }

  void profiles() {
    const info::LeastSquares least = problem(result_.noise.effective);
    const double share = options_.bootstrap > 0 ? 0.3 : 0.7;
    for (std::size_t k = 0; k < profiled_.size() && result_.complete; ++k) {
      if (!progress(0.3 + share * static_cast<double>(k) / static_cast<double>(profiled_.size()))) {
        return;
      }
      if (std::count(held_.begin(), held_.end(), profiled_[k]) > 0) continue;
      CalibratedParameter& parameter = result_.parameters[profiled_[k]];
      const double width = std::isfinite(parameter.sd) ? parameter.sd : parameter.priorSd;
      try {
        parameter.profile = info::profileInterval(
            least, estimate_, static_cast<Index>(profiled_[k]), width, estimateOptions());
      } catch (const std::domain_error& error) {
        result_.remarks.push_back(
            fmt::format("no profile likelihood of {}: {}", parameter.asked.name, error.what()));
      }
    }
  }

  void resample() {
    std::vector<Index> lengths;
    for (const MeasuredSeries& series : training_.series()) lengths.push_back(series.values.size());
    info::BootstrapOptions bootstrap;
    bootstrap.replicates = options_.bootstrap;
    bootstrap.seed = options_.seed;
    bootstrap.threads = options_.trials.threads;
    bootstrap.blockLength =
        std::max<Index>(1, std::lround(std::ceil(2 * result_.noise.correlationTime - 1)));
    bootstrap.estimate = estimateOptions();
    bootstrap.progress = [&](int done, int replicates) {
      return progress(0.6 + 0.4 * static_cast<double>(done) / static_cast<double>(replicates));
    };
    info::BootstrapResult spread;
    try {
      spread = info::bootstrap(problem(result_.noise.effective), estimate_, lengths, bootstrap);
    } catch (const std::domain_error& error) {
      result_.remarks.push_back(fmt::format("no bootstrap intervals: {}", error.what()));
      return;
    }
    result_.bootstrapConverged = spread.converged;
    for (Index i = 0; i < spread.sd.size(); ++i) {
      CalibratedParameter& parameter = result_.parameters[static_cast<std::size_t>(i)];
      if (!parameter.identifiable) continue;
      parameter.bootstrapSd = spread.sd[i];
      parameter.bootstrapLower = spread.intervals(i, 0);
      parameter.bootstrapUpper = spread.intervals(i, 1);
    }
  }

  const TrialSet& training_;
  const TrialSet* heldOut_;
  const CalibrationOptions& options_;
  std::vector<info::Parameter> asked_;
  VectorXd priorSds_;
  info::Predictor predictor_;
  MatrixXd measured_;
  ChannelNoise channels_;
  MatrixXd atStart_;
  std::vector<std::size_t> profiled_;
  std::vector<std::size_t> held_;
  info::Estimate estimate_;
  MatrixXd covariance_;  ///< at the estimate, of all numbers
  Calibration result_;
};

}  // namespace

VectorXd Calibration::values() const {
  VectorXd theta(static_cast<Index>(parameters.size()));
  for (Index i = 0; i < theta.size(); ++i) theta[i] = parameters[static_cast<std::size_t>(i)].value;
  return theta;
}

Calibration calibrate(const TrialSet& training, const TrialSet* heldOut,
                      const CalibrationOptions& options) {
  return Calibrator(training, heldOut, options).run();
}

}  // namespace bio
