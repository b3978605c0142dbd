#include "info/discovery/judgement/output_sd.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;

void ThirdDifferences::add(const std::vector<double>& times,
                           const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (std::size_t k = 3; k < times.size(); ++k) {
    const double step = times[k] - times[k - 1];
    if (std::abs(times[k - 1] - times[k - 2] - step) > 1e-3 * step ||
        std::abs(times[k - 2] - times[k - 3] - step) > 1e-3 * step)
      continue;
    const auto i = static_cast<Index>(k);
    const double third = values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3];
    if (!std::isfinite(third)) continue;
    squares += third * third;
    ++count;
  }
}

double ThirdDifferences::sd() const {
  return std::sqrt(squares / (20 * count));
}

OutputSd estimateOutputSd(const DiscoveryProblem& data, const std::vector<int>& trials) {
  ThirdDifferences differences;
  for (const int trial : trials) {
    const auto& channels = data.outputOfSample(trial);
    const int last = channels.empty() ? 0 : *std::max_element(channels.begin(), channels.end());
    for (int channel = 0; channel <= last; ++channel) {
      std::vector<double> times;
      std::vector<Index> samples;
      for (std::size_t k = 0; k < data.times(trial).size(); ++k) {
        if (!channels.empty() && channels[k] != channel) continue;
        times.push_back(data.times(trial)[k]);
        samples.push_back(static_cast<Index>(k));
      }
      differences.add(times, data.measured(trial)(samples));
    }
  }
  if (!(differences.squares > 0))
    throw std::invalid_argument(
        "standard deviation of the outputs: must have four equally spaced samples that do not lie "
        "on a parabola");
  // their autocorrelations are −15, 6, −1 of 20
  return {differences.sd(), std::sqrt(2 * (1 + 2 * 262.0 / 400.0) / differences.count)};
}

}  // namespace info::discover
