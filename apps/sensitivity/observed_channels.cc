#include "sensitivity/observed_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "options/quantity.h"
#include "output/text.h"

namespace app {

std::vector<bio::ChannelCandidate> readObserved(const std::vector<std::string>& typed,
                                                const bio::Model& model,
                                                const bio::MusculoskeletalSystem& arm) {
  std::vector<bio::ChannelCandidate> channels;
  for (const std::string& text : typed) {
    const Assignment one = parseAssignment(text);
    bio::ChannelCandidate channel{{bio::Observable::Kind::coordinate, one.name, 0}, one.value};
    const bool isCoordinate = bio::coordinateOrNull(model, one.name) != nullptr;
    if (!isCoordinate && !bio::readObservable(one.name, model, channel.what)) {
      throw std::invalid_argument(
          fmt::format("--observe: '{}' is nothing that can be measured of this model", one.name));
    }
    if (!(channel.sd > 0)) {
      throw std::invalid_argument(
          fmt::format("--observe: noise of '{}' = {}, must be > 0", one.name, channel.sd));
    }
    channels.push_back(std::move(channel));
  }
  (void)bio::ObservedMotion(arm, seriesOf(channels, {}));  // throws for what cannot be observed
  return channels;
}

std::string inWords(const std::vector<bio::ChannelCandidate>& channels, const bio::Model& model) {
  std::string text;
  for (const bio::ChannelCandidate& one : channels) {
    text += fmt::format("{}{} (noise {} {})", text.empty() ? "" : ", ", nameOf(one.what),
                        numberText(one.sd), bio::unitOf(one.what, model));
  }
  return text;
}

std::vector<bio::ObservedSeries> seriesOf(const std::vector<bio::ChannelCandidate>& channels,
                                          const std::vector<double>& times) {
  const auto n = static_cast<Eigen::Index>(times.size());
  std::vector<bio::ObservedSeries> series;
  for (const bio::ChannelCandidate& one : channels) {
    series.push_back({one.what, Eigen::VectorXd::Map(times.data(), n)});
  }
  return series;
}

void scaleByNoise(const std::vector<bio::ChannelCandidate>& channels, Eigen::MatrixXd& gamma) {
  if (channels.empty()) return;
  const auto n = gamma.rows() / static_cast<Eigen::Index>(channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    gamma.middleRows(static_cast<Eigen::Index>(i) * n, n) /= channels[i].sd;
  }
}

std::vector<bio::ChannelCandidate> furtherChannels(
    const bio::MusculoskeletalSystem& arm, const std::vector<bio::ChannelCandidate>& observed,
    const std::string& coordinate) {
  std::vector<bio::Observable> seen;
  for (const bio::ChannelCandidate& one : observed) seen.push_back(one.what);
  if (observed.empty()) seen.push_back({bio::Observable::Kind::coordinate, coordinate, 0});
  std::vector<bio::ChannelCandidate> candidates = bio::usualChannels(arm);
  std::erase_if(candidates, [&](const bio::ChannelCandidate& one) {
    return std::find(seen.begin(), seen.end(), one.what) != seen.end();
  });
  return candidates;
}

bool gainsTakeLong(std::size_t parameters, std::size_t channels) {
  const double work = std::pow(static_cast<double>(parameters), 3) * static_cast<double>(channels);
  return work > 2e9;  // 285 parameters and 25 channels, 5.8e8, take 0.3 s
}

}  // namespace app
