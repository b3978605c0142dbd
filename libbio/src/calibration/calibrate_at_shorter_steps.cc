#include "bio/calibration/calibrate_at_shorter_steps.h"

#include <algorithm>
#include <cmath>

#include "calibration/channel_noise.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

StepChange changeOfHalving(const Model& model, const SystemOptions& system,
                           const TrialSet& training, const CalibrationOptions& options,
                           const Calibration& calibration) {
  StepChange change;
  TrialSetOptions halved = options.trials;
  halved.simulation.step /= 2;
  const TrialSet finer(model, system, training.trials(), halved);
  const VectorXd theta = calibration.values();
  const MatrixXd there = finer.predictor().outputs(theta);
  std::vector<double> sds;
  for (const ResidualNoise& noise : calibration.channelNoise) sds.push_back(noise.sd);
  change.ofTrials = finer.largestDifferences(there, calibration.after, sds);
  if (!there.allFinite()) return change;
  ChannelNoise noise(training, options);
  noise.weigh(calibration.channelNoise);
  const MatrixXd gamma = noise.weighted(training.predictor()).withSensitivities(theta).gamma;
  const VectorXd by = (noise.weighted(there) - noise.weighted(calibration.after)).transpose() /
                      calibration.noise.effective;
  std::vector<Index> free;
  for (std::size_t i = 0; i < calibration.parameters.size(); ++i) {
    if (!calibration.parameters[i].atBound) free.push_back(static_cast<Index>(i));
  }
  MatrixXd slopes = gamma(Eigen::all, free) / calibration.noise.effective;
  VectorXd scale(slopes.cols());
  for (Index k = 0; k < scale.size(); ++k)
    scale[k] =
        calibration.parameters[static_cast<std::size_t>(free[static_cast<std::size_t>(k)])].priorSd;
  slopes *= scale.asDiagonal();
  MatrixXd information = slopes.transpose() * slopes;
  for (Index k = 0; k < scale.size(); ++k) {
    const auto i = static_cast<std::size_t>(free[static_cast<std::size_t>(k)]);
    const auto& prior = calibration.parameters[i].asked.prior;
    information(k, k) += prior ? std::pow(scale[k] / prior->sd, 2) : 1e-12;
  }
  const VectorXd shift =
      scale.asDiagonal() * information.ldlt().solve(slopes.transpose() * by).eval();
  for (Index k = 0; k < shift.size(); ++k) {
    const auto i = static_cast<std::size_t>(free[static_cast<std::size_t>(k)]);
    const double sd = calibration.parameters[i].sd;
    if (sd > 0) change.ofEstimates = std::max(change.ofEstimates, std::abs(shift[k]) / sd);
  }
  return change;
}

}  // namespace

bool StepChange::mattersToTrial(std::size_t trial) const {
  return ofTrials[trial].difference > 0.2 * ofTrials[trial].sd;
}

bool StepChange::mattersToEstimates() const {
  return ofEstimates > 0.25;
}

bool StepChange::matters() const {
  for (std::size_t i = 0; i < ofTrials.size(); ++i) {
    if (mattersToTrial(i)) return true;
  }
  return mattersToEstimates();
}

SteppedCalibration calibrateAtShorterSteps(const Model& model, const SystemOptions& system,
                                           const std::vector<Trial>& training,
                                           const std::vector<Trial>& heldOut,
                                           const CalibrationOptions& options, double shortest) {
  SteppedCalibration result;
  result.options = options;
  const bool mayShorten = isVariational(options.trials.simulation.integrator);
  for (bool isFirst = true;; isFirst = false) {
    const TrialSetOptions& trials = result.options.trials;
    result.training = std::make_unique<const TrialSet>(model, system, training, trials);
    if (!heldOut.empty()) {
      TrialSetOptions tested = trials;
      tested.latent = false;  // a prediction knows only what is expected
      result.heldOut = std::make_unique<const TrialSet>(model, system, heldOut, tested);
    }
    const double half = trials.simulation.step / 2;
    bool isFinal = true;
    result.options.isFinal = [&](const Calibration& now) {
      if (!now.calibrated) return true;
      result.change = changeOfHalving(model, system, *result.training, result.options, now);
      isFinal = !mayShorten || half < shortest || !result.change.matters();
      return isFinal && (!options.isFinal || options.isFinal(now));
    };
    Calibration found = calibrate(*result.training, result.heldOut.get(), result.options);
    result.options.isFinal = options.isFinal;
    if (!isFirst) {
      found.starts = std::move(result.calibration.starts);
      found.agreeingStarts = result.calibration.agreeingStarts;
      found.iterations += result.calibration.iterations;
      found.evaluations += result.calibration.evaluations;
    }
    result.calibration = std::move(found);
    if (isFinal || !result.calibration.complete) return result;
    result.options.trials.simulation.step = half;
    result.options.from = result.calibration.values();
    result.options.candidates = std::move(result.calibration.candidates);
  }
}

}  // namespace bio
