#pragma once

#include <fmt/format.h>

#include <cmath>

#include "bio/calibration/calibrate.h"
#include "info/parallel_for.h"
#include "support/synthetic_elbow.h"

// Calibrations repeated on synthetic trials whose truth is known. Noise of 0.5° is drawn anew each
// time and estimated with the parameters; there are no priors.
namespace bio::fixtures {

inline const std::vector<std::pair<std::string, double>> kTruth = {
    {"hand.mass", 0.65}, {"TRI.radius", 0.0172}, {"TRIlong.max_isometric_force", 700}};

struct CalibrationStatistics {
  int repetitions = 0, converged = 0;
  Eigen::Array3d bias;      ///< of the mean, in its own standard errors
  Eigen::Array3d variance;  ///< of the estimates, in units of the Cramér–Rao bound at the truth
  Eigen::Array3d coverage;  ///< share of 95 % intervals that hold the truth
  double noise = 0;         ///< mean of the estimated [deg]
};

inline CalibrationStatistics repeatCalibration(int repetitions) {
  const SyntheticElbow elbow;
  const std::map<std::string, double> truth(kTruth.begin(), kTruth.end());
  const Trial slow = elbow.trial("curl_slow", 2.5, truth, 30, 2);
  const Trial fast = elbow.trial("curl_fast", 2, truth, 25, 2);
  CalibrationOptions options;
  for (const auto& [name, value] : kTruth) options.trials.parameters.push_back(name);
  options.priors = false;

  // the bound at the truth
  const TrialSet exact(elbow.model, SyntheticElbow::options(), {slow, fast}, options.trials);
  Eigen::Vector3d theta;
  for (Eigen::Index i = 0; i < 3; ++i) theta[i] = kTruth[static_cast<std::size_t>(i)].second;
  const Eigen::MatrixXd gamma = exact.predictor().withSensitivities(theta).gamma;
  const double sigma = 0.5 / 180 * 3.141592653589793;
  const Eigen::Array3d bound =
      ((gamma.transpose() * gamma).inverse() * sigma * sigma).diagonal().array();

  Eigen::Array3Xd estimates(3, repetitions), covered(3, repetitions);
  Eigen::ArrayXd noise(repetitions), converged(repetitions);
  info::parallelFor(repetitions, 0, [&](int i) {
    const auto stream = static_cast<std::uint64_t>(i);
    const TrialSet trials(
        elbow.model, SyntheticElbow::options(),
        {SyntheticElbow::noisy(slow, 0.5, 1, stream), SyntheticElbow::noisy(fast, 0.5, 2, stream)},
        options.trials);
    const Calibration found = calibrate(trials, nullptr, options);
    converged[i] = found.converged;
    noise[i] = found.noise.sd / sigma * 0.5;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const CalibratedParameter& one = found.parameters[static_cast<std::size_t>(k)];
      estimates(k, i) = one.value;
      covered(k, i) = one.identifiable && one.lower <= theta[k] && theta[k] <= one.upper;
    }
  });
  CalibrationStatistics result;
  result.repetitions = repetitions;
  result.converged = static_cast<int>(converged.sum());
  const Eigen::Array3d mean = estimates.rowwise().mean();
  const Eigen::Array3d variance =
      (estimates.colwise() - mean).square().rowwise().sum() / (repetitions - 1);
  result.bias = (mean - theta.array()) / (variance / repetitions).sqrt();
  result.variance = variance / bound;
  result.coverage = covered.rowwise().mean();
  result.noise = noise.mean();
  fmt::print("{} repetitions, {} converged, noise {:.4f} deg\n", repetitions, result.converged,
             result.noise);
  for (Eigen::Index k = 0; k < 3; ++k) {
    fmt::print(
        "{:<28} sd {:.3g}  bias {:+.2f} standard errors  variance/bound {:.3f}  coverage "
        "{:.1f} %\n",
        kTruth[static_cast<std::size_t>(k)].first, std::sqrt(variance[k]), result.bias[k],
        result.variance[k], result.coverage[k] * 100);
  }
  return result;
}

}  // namespace bio::fixtures
