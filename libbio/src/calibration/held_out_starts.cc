#include "calibration/held_out_starts.h"

#include <algorithm>
#include <stdexcept>

#include "calibration/channel_noise.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd valuesOfHeldOut(const TrialSet& heldOut, const VectorXd& common, const TrialSet& training,
                         const std::vector<ResidualNoise>& noises,
                         const CalibrationOptions& options, const info::EstimateOptions& estimate) {
  std::vector<info::Parameter> parameters = heldOut.parameters();
  VectorXd values(static_cast<Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (k < common.size()) {
      parameters[i].lower = parameters[i].upper = parameters[i].start = common[k];
      parameters[i].prior.reset();
    }
    values[k] = parameters[i].start;
  }
  if (values.size() == common.size()) return values;
  CalibrationOptions own = options;
  own.channelNoise.clear();  // of channels that these trials may not have
  ChannelNoise channels(heldOut, own);
  std::vector<ResidualNoise> given;
  for (const MeasuredGroup& group : heldOut.channels()) {
    const auto& all = training.channels();
    const auto same = std::find_if(
        all.begin(), all.end(), [&](const MeasuredGroup& one) { return one.name == group.name; });
    if (same == all.end()) return values;  // its noise is not known
    given.push_back(noises[static_cast<std::size_t>(same - all.begin())]);
  }
  channels.weigh(given);
  const double sigma = given.front().effective;
  const info::OutputCovariance covariance(MatrixXd::Constant(1, 1, sigma * sigma));
  const info::LeastSquares problem(
      channels.weighted(heldOut.predictor()),
      {channels.weighted(heldOut.measured()), covariance, {}, options.loss}, parameters);
  try {
    return info::estimate(problem, values, estimate).parameters;
  } catch (const std::domain_error&) {
    return values;  // it cannot be simulated; its residuals say so
  }
}

VectorXd predictionSd(const TrialSet& heldOut, const VectorXd& values, const MatrixXd& covariance) {
  const MatrixXd gamma =
      heldOut.predictor().withSensitivities(values).gamma.leftCols(covariance.cols());
  return (gamma * covariance).cwiseProduct(gamma).rowwise().sum().cwiseMax(0).cwiseSqrt();
}

}  // namespace bio
