#include "info/discovery/likelihood/recorded_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "discovery/likelihood/selected_samples.h"
#include "info/discovery/likelihood/hypothesis.h"
#include "info/discovery/likelihood/joint_fit.h"

namespace info::discover {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

using Kept = std::vector<std::vector<std::size_t>>;

constexpr double kMadOfNormal = 1.4826;

// Outliers.
constexpr std::size_t kNeighbours = 4;    // on either side
constexpr double kLongestWindow = 0.15;   // [s] over which a parabola follows the motion
constexpr double kOutlier = 8;            // robust deviations
constexpr double kMostOutliers = 1 / 6.;  // of all samples

// Correlation.
constexpr int kMostSpacing = 12;
constexpr double kLongestInterval = 0.12;  // [s] between samples that are kept
constexpr double kPlateau = 1.15;
constexpr std::array kHolds = {12.0, 8.0, 5.0};  // nudging frequencies tried [rad/s]
constexpr double kHoldSpread = 3;                // noise of the nudged fits [σ_y]

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Sample k less the value of the parabola of least absolute deviations through its neighbours.
double offParabola(const std::vector<double>& times, const VectorXd& y, std::size_t k) {
  const std::size_t width = 2 * kNeighbours;
  const std::size_t first =
      std::min(k > kNeighbours ? k - kNeighbours : 0, times.size() - 1 - width);
  std::array<double, 2 * kNeighbours> x{}, v{}, weight{};
  std::size_t n = 0;
  const double scale = times[first + width] - times[first];
  for (std::size_t i = first; i <= first + width; ++i) {
    if (i == k) continue;
    x[n] = (times[i] - times[k]) / scale;
    v[n++] = y[static_cast<Index>(i)];
  }
  weight.fill(1);
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int round = 0; round < 12; ++round) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d row(1, x[i], x[i] * x[i]);
      A += weight[i] * row * row.transpose();
      b += weight[i] * v[i] * row;
    }
    c = A.ldlt().solve(b);
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i)
      mean += std::abs(v[i] - c[0] - c[1] * x[i] - c[2] * x[i] * x[i]) / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double r = std::abs(v[i] - c[0] - c[1] * x[i] - c[2] * x[i] * x[i]);
      weight[i] = 1 / std::max(r, 1e-3 * mean + 1e-300);
    }
  }
  return y[static_cast<Index>(k)] - c[0];
}

// For one trial with one output; the samples at either end are extrapolated, with a scale of their
// own.
std::vector<bool> outliersOf(const std::vector<double>& times, const VectorXd& y) {
  std::vector<bool> out(times.size(), false);
  const std::size_t width = 2 * kNeighbours + 1;
  if (times.size() < 3 * width) return out;
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  if (median(steps) * static_cast<double>(width) > kLongestWindow) return out;
  std::vector<double> off(times.size()), sizes;
  for (std::size_t k = 0; k < times.size(); ++k) {
    off[k] = std::abs(offParabola(times, y, k));
    const bool inside = k >= kNeighbours && k + kNeighbours < times.size();
    if (inside) sizes.push_back(off[k]);
  }
  const double sd = kMadOfNormal * median(sizes);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::size_t toEnd = std::min(k, times.size() - 1 - k);
    const double wider =
        toEnd >= kNeighbours ? 1 : 1 + 0.75 * static_cast<double>(kNeighbours - toEnd);
    out[k] = sd > 0 && off[k] > kOutlier * wider * sd;
  }
  return out;
}

// The quantisation step of the values, if many are equal.
double quantumOf(const DiscoveryProblem& data, const std::vector<int>& trials) {
  std::vector<double> values;
  for (const int trial : trials) {
    const VectorXd& y = data.measured(trial);
    values.insert(values.end(), y.begin(), y.end());
  }
  std::sort(values.begin(), values.end());
  const double range = values.back() - values.front(), same = 1e-6 * range;
  double quantum = range;
  std::size_t different = 1;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = values[k] - values[k - 1];
    if (step <= same) continue;
    ++different;
    quantum = std::min(quantum, step);
  }
  return 2 * different < values.size() ? quantum : 0;
}

// Residuals of the nudged model at its best parameters, by trial.
std::optional<std::vector<VectorXd>> residuals(const DiscoveryProblem& data,
                                               const std::vector<int>& trials, double sd) {
  VectorXd values = nominalValues(data);
  std::vector<VectorXd> left;
  for (const double frequency : kHolds) {
    const auto held = data.nudged(frequency);
    if (!held) return {};
    const Likelihood likelihood(*held, trials, values);
    const auto fit = likelihood.tryFit(makeHypothesis(data, {}, trials),
                                       {kHoldSpread * sd, 0, 0.08}, values, {}, {6, 0.1});
    if (!fit) return {};
    values = fit->values;
    left.clear();
    for (const int trial : trials)
      left.push_back(held->measured(trial) - held->outputs(trial, values, {}));
  }
  return left;
}

// Third differences over m samples of one trial.
ThirdDifferences over(int m, const std::vector<double>& times, const VectorXd& values) {
  ThirdDifferences sum;
  const auto step = static_cast<std::size_t>(m);
  for (std::size_t phase = 0; phase < step; ++phase) {
    std::vector<double> t;
    std::vector<Index> samples;
    for (std::size_t k = phase; k < times.size(); k += step) {
      t.push_back(times[k]);
      samples.push_back(static_cast<Index>(k));
    }
    sum.add(t, values(samples));
  }
  return sum;
}

}  // namespace

RecordedNoise recordedNoise(const DiscoveryProblem& data, const std::vector<int>& trials,
                            const std::optional<Whitening>& givenSd) {
  RecordedNoise noise;
  Kept& kept = noise.kept;
  bool single = true;
  for (int trial = 0; trial < data.numTrials(); ++trial) {
    std::vector<std::size_t> all(data.times(trial).size());
    std::iota(all.begin(), all.end(), 0);
    noise.samples += all.size();
    kept.push_back(std::move(all));
    single = single && data.outputOfSample(trial).empty();
  }
  // samples may be too sparse to tell it
  const std::vector<ThirdDifferences> told = differencesOf(data, trials);
  const auto tellsNothing = [](const ThirdDifferences& d) { return !(d.squares > 0); };
  if (givenSd && std::any_of(told.begin(), told.end(), tellsNothing)) {
    noise.sd = {*givenSd, 0};
    return noise;
  }
  noise.sd = estimateOutputSd(data, trials);
  if (!single) return noise;

  Kept good;
  std::size_t outliers = 0;
  for (int trial = 0; trial < data.numTrials(); ++trial) {
    const std::vector<bool> out = outliersOf(data.times(trial), data.measured(trial));
    good.emplace_back();
    for (std::size_t k = 0; k < out.size(); ++k)
      if (!out[k]) good.back().push_back(k);
    outliers += out.size() - good.back().size();
  }
  if (static_cast<double>(outliers) <= kMostOutliers * static_cast<double>(noise.samples)) {
    kept = std::move(good);
    noise.outliers = outliers;
  }
  const SelectedSamples selected(data, kept);
  if (noise.outliers > 0) noise.sd = estimateOutputSd(selected, trials);
  const double quantum = quantumOf(selected, trials);
  if (const double found = noise.sd.value.sd(0); quantum > found) {
    noise.quantum = quantum;
    noise.sd.value = std::max(found, noise.leastSd());
  }

  const auto left = residuals(selected, trials, noise.sd.value.sd(0));
  if (!left) return noise;
  std::array<ThirdDifferences, 2 * kMostSpacing + 1> differences;
  for (int m = 1; m <= 2 * kMostSpacing; ++m)
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const ThirdDifferences one = over(m, selected.times(trials[i]), (*left)[i]);
      differences[static_cast<std::size_t>(m)].squares += one.squares;
      differences[static_cast<std::size_t>(m)].count += one.count;
    }
  const auto& times = selected.times(trials.front());
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  const auto sd = [&](int m) {
    const ThirdDifferences& d = differences[static_cast<std::size_t>(m)];
    return d.count > 10 ? d.sd() : 0.0;
  };
  int m = 1;
  while (m < kMostSpacing && (m + 1) * step <= kLongestInterval && sd(2 * m) > kPlateau * sd(m))
    ++m;
  if (m == 1) return noise;
  noise.spacing = m;
  noise.interval = m * step;
  noise.sd.value = std::max(sd(m), noise.leastSd());
  noise.sd.relativeError =
      std::sqrt(2 * (1 + 2 * 262.0 / 400.0) * m / differences[static_cast<std::size_t>(m)].count);
  for (auto& one : kept) {
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < one.size(); k += static_cast<std::size_t>(m))
      some.push_back(one[k]);
    one = std::move(some);
  }
  return noise;
}

}  // namespace info::discover
