#include "info/discovery/judgement/output_sd.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace info::discover {

using Eigen::Index;

namespace {

/// Whether the four samples that end with the k-th are equally spaced.
bool areEquallySpaced(const std::vector<double>& times, std::size_t k) {
  const double step = times[k] - times[k - 1];
  return std::abs(times[k - 1] - times[k - 2] - step) <= 1e-3 * step &&
         std::abs(times[k - 2] - times[k - 3] - step) <= 1e-3 * step;
}

bool areNearlyEquallySpaced(const std::vector<double>& times, std::size_t k) {
  constexpr double mostRatio = 3.5;
  const auto [least, most] = std::minmax(
      {times[k] - times[k - 1], times[k - 1] - times[k - 2], times[k - 2] - times[k - 3]});
  return least > 0 && most <= mostRatio * least;
}

/// The third divided difference of the four samples that end with the k-th, scaled so that white
/// noise has twenty times its variance in it, as in Δ³y.
double scaledDifference(const std::vector<double>& times,
                        const Eigen::Ref<const Eigen::VectorXd>& values, std::size_t k) {
  double sum = 0, squares = 0;
  const double span = times[k] - times[k - 3];
  for (std::size_t i = k - 3; i <= k; ++i) {
    double weight = 1;
    for (std::size_t j = k - 3; j <= k; ++j)
      if (j != i) weight *= span / (times[i] - times[j]);
    sum += weight * values[static_cast<Index>(i)];
    squares += weight * weight;
  }
  return sum * std::sqrt(20 / squares);
}

}  // namespace

void ThirdDifferences::add(const std::vector<double>& times,
                           const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::size_t equal = 0;
  for (std::size_t k = 3; k < times.size(); ++k) equal += areEquallySpaced(times, k);
  const bool mostAreEqual = 2 * (equal + 3) >= times.size();
  for (std::size_t k = 3; k < times.size(); ++k) {
    const auto i = static_cast<Index>(k);
    double third;
    if (areEquallySpaced(times, k)) {
      third = values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3];
    } else if (!mostAreEqual && areNearlyEquallySpaced(times, k)) {
      third = scaledDifference(times, values, k);
    } else {
      continue;
    }
    if (!std::isfinite(third)) continue;
    squares += third * third;
    ++count;
  }
}

double ThirdDifferences::sd() const {
  return std::sqrt(squares / (20 * count));
}

std::vector<ThirdDifferences> differencesOf(const DiscoveryProblem& data,
                                            const std::vector<int>& trials) {
  std::vector<ThirdDifferences> differences(1);
  for (const int trial : trials) {
    const auto& channels = data.outputOfSample(trial);
    const int last = channels.empty() ? 0 : *std::max_element(channels.begin(), channels.end());
    if (differences.size() <= static_cast<std::size_t>(last))
      differences.resize(static_cast<std::size_t>(last) + 1);
    for (int channel = 0; channel <= last; ++channel) {
      std::vector<double> times;
      std::vector<Index> samples;
      for (std::size_t k = 0; k < data.times(trial).size(); ++k) {
        if (!channels.empty() && channels[k] != channel) continue;
        times.push_back(data.times(trial)[k]);
        samples.push_back(static_cast<Index>(k));
      }
      differences[static_cast<std::size_t>(channel)].add(times, data.measured(trial)(samples));
    }
  }
  return differences;
}

OutputSd estimateOutputSd(const DiscoveryProblem& data, const std::vector<int>& trials) {
  const std::vector<ThirdDifferences> differences = differencesOf(data, trials);
  Eigen::VectorXd sds(static_cast<Index>(differences.size()));
  double count = 0;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (!(differences[i].squares > 0))
      throw std::invalid_argument(
          "standard deviation of the outputs: must have four samples in a row that do not lie on a "
          "parabola; give the noise instead");
    sds[static_cast<Index>(i)] = differences[i].sd();
    count += differences[i].count;
  }
  // their autocorrelations are −15, 6, −1 of 20
  return {Whitening(std::move(sds)), std::sqrt(2 * (1 + 2 * 262.0 / 400.0) / count)};
}

}  // namespace info::discover
