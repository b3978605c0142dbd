#include "info/discover/output_deviation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;

OutputDeviation estimateOutputDeviation(const Disagreement& data, const std::vector<int>& trials) {
  double sum = 0;
  double count = 0;
  const auto add = [&](const std::vector<double>& t, const std::vector<double>& y) {
    for (std::size_t k = 3; k < t.size(); ++k) {
      const double step = t[k] - t[k - 1];
      if (std::abs(t[k - 1] - t[k - 2] - step) > 1e-3 * step ||
          std::abs(t[k - 2] - t[k - 3] - step) > 1e-3 * step)
        continue;
      const double third = y[k] - 3 * y[k - 1] + 3 * y[k - 2] - y[k - 3];
      sum += third * third;
      ++count;
    }
  };
  for (const int trial : trials) {
    const auto& channels = data.outputOfSample(trial);
    const int last = channels.empty() ? 0 : *std::max_element(channels.begin(), channels.end());
    for (int channel = 0; channel <= last; ++channel) {
      std::vector<double> t, y;
      for (std::size_t k = 0; k < data.times(trial).size(); ++k) {
        if (!channels.empty() && channels[k] != channel) continue;
        t.push_back(data.times(trial)[k]);
        y.push_back(data.measured(trial)[static_cast<Index>(k)]);
      }
      add(t, y);
    }
  }
  if (!(sum > 0))
    throw std::invalid_argument(
        "output deviation: there must be four equally spaced samples that are not on a parabola");
  // third differences of white noise have variance 20σ², and autocorrelations −15, 6, −1 of 20
  return {std::sqrt(sum / (20 * count)), std::sqrt(2 * (1 + 2 * 262.0 / 400.0) / count)};
}

}  // namespace info::discover
