#include "calibration/channel_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibration/nudged_starts.h"
#include "info/estimation/residuals.h"

namespace bio {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ChannelNoise::ChannelNoise(const TrialSet& trials, const CalibrationOptions& options)
    : trials_(trials), options_(options), measured_(trials.measured()) {
  for (const auto& given : options_.channelNoise) {
    const std::string& name = given.first;
    const double sd = given.second;
    const auto& channels = trials_.channels();
    const bool isThere = std::any_of(channels.begin(), channels.end(), [&](const auto& channel) {
      return channel.name == name && !channel.areAngles;
    });
    if (!isThere) {
      throw std::invalid_argument(fmt::format("noise of '{}': no trial measures it", name));
    }
    if (!(sd > 0 && std::isfinite(sd))) {
      throw std::invalid_argument(fmt::format("noise of '{}' = {}, must be > 0", name, sd));
    }
  }
}

std::optional<double> ChannelNoise::given(std::size_t channel) const {
  const MeasuredGroup& group = trials_.channels()[channel];
  if (group.areAngles) return options_.noise;
  const auto at = options_.channelNoise.find(group.name);
  if (at == options_.channelNoise.end()) return {};
  return at->second;
}

std::vector<VectorXd> ChannelNoise::residuals(const MatrixXd& predicted,
                                              std::size_t channel) const {
  std::vector<VectorXd> series;
  Index at = 0;
  for (const MeasuredSeries& one : trials_.series()) {
    const Index n = one.values.size();
    if (one.channel == channel) {
      series.push_back(one.values - predicted.middleCols(at, n).transpose());
    }
    at += n;
  }
  return series;
}

std::vector<ResidualNoise> ChannelNoise::shown() const {
  std::vector<ResidualNoise> noises;
  const MatrixXd nothing = MatrixXd::Zero(1, measured_.size());
  for (std::size_t channel = 0; channel < trials_.channels().size(); ++channel) {
    const double least = trials_.channels()[channel].areAngles
                             ? 1e-4
                             : std::max(1e-3 * std::sqrt(trials_.meanSquareOf(nothing, channel)),
                                        std::numeric_limits<double>::min());
    ResidualNoise& noise = noises.emplace_back();
    noise.sd = std::max(given(channel).value_or(measuredSd(trials_, channel)), least);
    noise.effective = noise.sd;
  }
  return noises;
}

std::vector<ResidualNoise> ChannelNoise::of(const MatrixXd& predicted, Index fitted) const {
  std::vector<ResidualNoise> noises;
  for (std::size_t channel = 0; channel < trials_.channels().size(); ++channel) {
    const std::vector<VectorXd> series = residuals(predicted, channel);
    Index samples = 0;
    for (const VectorXd& one : series) samples += one.size();
    const double share = static_cast<double>(samples) / static_cast<double>(measured_.size());
    noises.push_back(ofSeries(series, static_cast<double>(fitted) * share, given(channel)));
  }
  return noises;
}

ResidualNoise ChannelNoise::ofSeries(const std::vector<VectorXd>& series, double fitted,
                                     const std::optional<double>& given) const {
  Index samples = 0;
  for (const VectorXd& one : series) samples += one.size();
  VectorXd r(samples);
  Index at = 0;
  for (const VectorXd& one : series) {
    r.segment(at, one.size()) = one;
    at += one.size();
  }
  ResidualNoise noise;
  const bool gaussian = options_.loss.kind == info::RobustLoss::Kind::gaussian;
  const double freedom = std::max(1.0, static_cast<double>(samples) - fitted);
  noise.sd = gaussian ? std::sqrt(r.squaredNorm() / freedom) : info::robustSd(r);
  if (r.squaredNorm() > 0) noise.autocorrelation = info::autocorrelation(series, samples / 4);
  if (given) {
    noise.sd = *given;
  } else {
    noise.correlationTime = info::autocorrelationTime(noise.autocorrelation, samples);
  }
  // what repeats exactly still was not measured better than this [rad, or the channel's unit]
  noise.sd = std::max(noise.sd, 1e-9);
  noise.effective = noise.sd * std::sqrt(noise.correlationTime);
  return noise;
}

double ChannelNoise::distance(const MatrixXd& predicted) const {
  if (areOne()) return (measured_ - predicted).norm();
  const MatrixXd nothing = MatrixXd::Zero(1, measured_.size());
  double sum = 0;
  for (std::size_t channel = 0; channel < trials_.channels().size(); ++channel) {
    const double size =
        std::max(trials_.meanSquareOf(nothing, channel), std::numeric_limits<double>::min());
    sum += trials_.meanSquareOf(predicted, channel) / size;
  }
  return sum;
}

void ChannelNoise::weigh(const std::vector<ResidualNoise>& noises) {
  if (areOne()) return;
  weight_.resize(1, measured_.size());
  Index at = 0;
  for (const MeasuredSeries& series : trials_.series()) {
    const Index n = series.values.size();
    weight_.middleCols(at, n).setConstant(noises[series.channel].effective /
                                          noises.front().effective);
    at += n;
  }
}

MatrixXd ChannelNoise::weighted(const MatrixXd& outputs) const {
  if (weight_.size() == 0) return outputs;
  return outputs.cwiseQuotient(weight_);
}

info::Predictor ChannelNoise::weighted(const info::Predictor& predictor) const {
  if (weight_.size() == 0) return predictor;
  info::Predictor scaled;
  scaled.outputs = [outputs = predictor.outputs, weight = weight_](const VectorXd& theta) {
    return MatrixXd(outputs(theta).cwiseQuotient(weight));
  };
  scaled.withSensitivities = [both = predictor.withSensitivities,
                              weight = weight_](const VectorXd& theta) {
    info::Prediction at = both(theta);
    at.outputs = at.outputs.cwiseQuotient(weight).eval();
    at.gamma.array().colwise() /= weight.transpose().array().col(0);
    return at;
  };
  scaled.whyUndefined = predictor.whyUndefined;
  return scaled;
}

}  // namespace bio
