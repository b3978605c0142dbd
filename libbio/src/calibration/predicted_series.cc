#include "bio/calibration/predicted_series.h"

#include <algorithm>
#include <cmath>

#include "info/estimation/monte_carlo.h"

namespace bio {
namespace {

using Eigen::Index;

/// Noise of the calibration trials' channel of this name; NaN if they have none.
double noiseOf(const TrialSet& training, const Calibration& calibration,
               const std::string& channel) {
  const auto& all = training.channels();
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const MeasuredGroup& group) { return group.name == channel; });
  if (at == all.end()) return std::nan("");
  return calibration.channelNoise[static_cast<std::size_t>(at - all.begin())].sd;
}

}  // namespace

std::vector<PredictedSeries> predictedSeries(const TrialSet& training, const TrialSet& heldOut,
                                             const Calibration& calibration, double confidence) {
  std::vector<PredictedSeries> all;
  if (calibration.heldOutSd.size() == 0) return all;
  const double z = info::normalQuantile(confidence);
  Index first = 0;
  for (const MeasuredSeries& series : heldOut.series()) {
    const Index n = series.values.size();
    const Eigen::VectorXd& measured = series.values;
    const Eigen::VectorXd predicted = calibration.heldOutAfter.middleCols(first, n).transpose();
    const Eigen::VectorXd sd = calibration.heldOutSd.segment(first, n);
    first += n;
    PredictedSeries one;
    one.series = all.size();
    one.noise = noiseOf(training, calibration, heldOut.channels()[series.channel].name);
    const Eigen::ArrayXd half = z * (sd.array().square() + one.noise * one.noise).sqrt();
    Index ofMeasured = 0, ofPredicted = 0;
    measured.cwiseAbs().maxCoeff(&ofMeasured);
    predicted.cwiseAbs().maxCoeff(&ofPredicted);
    one.measuredPeak = measured[ofMeasured];
    one.predictedPeak = predicted[ofPredicted];
    one.sdOfEstimates = sd[ofPredicted];
    one.lower = one.predictedPeak - half[ofPredicted];
    one.upper = one.predictedPeak + half[ofPredicted];
    if (std::isnan(one.noise)) {
      one.shareHeld = std::nan("");
    } else {
      one.holdsPeak = one.lower <= one.measuredPeak && one.measuredPeak <= one.upper;
      one.shareHeld = ((measured - predicted).array().abs() <= half).cast<double>().mean();
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace bio
