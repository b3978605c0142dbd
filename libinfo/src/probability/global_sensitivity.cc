#include "info/probability/global_sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "info/parallel_for.h"
#include "info/probability/quantile.h"
#include "info/probability/random_stream.h"

namespace info {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int maxDimension = 64;

const std::vector<int>& primes() {
  static const std::vector<int> list = [] {
    std::vector<int> found;
    for (int n = 2; static_cast<int>(found.size()) < maxDimension; ++n) {
      const bool isPrime =
          std::none_of(found.begin(), found.end(), [&](int p) { return n % p == 0; });
      if (isPrime) found.push_back(n);
    }
    return found;
  }();
  return list;
}

/// All points through the model, in parallel; an empty vector where it is undefined.
struct Runs {
  std::vector<VectorXd> outputs;
  int undefined = 0;
  bool complete = true;
};
Runs runAll(const CubeModel& model, const std::vector<VectorXd>& points,
            const EnsembleOptions& options) {
  Runs runs;
  runs.outputs.resize(points.size());
  std::atomic<bool> stopped{false};
  int done = 0;
  std::mutex mutex;
  parallelFor(static_cast<int>(points.size()), options.threads, [&](int i) {
    if (stopped) return;
    VectorXd y = model(points[static_cast<std::size_t>(i)]);
    if (y.allFinite()) runs.outputs[static_cast<std::size_t>(i)] = std::move(y);
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress && !options.progress(done, static_cast<int>(points.size()))) {
      stopped = true;
    }
  });
  runs.complete = !stopped;
  for (const VectorXd& y : runs.outputs) runs.undefined += y.size() == 0 ? 1 : 0;
  return runs;
}

/// Mean and its standard error; every value counts as often as its weight says.
struct Mean {
  double value = 0, error = 0;
};
Mean meanOf(const std::vector<double>& x, const std::vector<double>& weights) {
  const double n = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(n > 0)) return {std::nan(""), std::nan("")};
  double mean = 0, squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean += weights[i] * x[i];
  mean /= n;
  for (std::size_t i = 0; i < x.size(); ++i) squares += weights[i] * (x[i] - mean) * (x[i] - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : std::nan("")};
}
Mean meanOf(const std::vector<double>& x) {
  return meanOf(x, std::vector<double>(x.size(), 1.0));
}

/// Indices of base points that count as often as their weights say.
SobolResult weightedIndices(const std::vector<VectorXd>& outputs, Index p,
                            const std::vector<double>& weights) {
  const auto stride = static_cast<std::size_t>(p + 2);
  const std::size_t n = weights.size();
  SobolResult result;
  result.first.setConstant(p, std::nan(""));
  result.total = result.firstDeviation = result.totalSd = result.first;
  result.runs = static_cast<int>(outputs.size());
  for (const VectorXd& y : outputs) result.undefined += y.size() == 0 ? 1 : 0;

  // mean and variance over A and B; the mean is taken off, which steadies the estimate of S
  VectorXd mean;
  double count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      const VectorXd& y = outputs[k * stride + side];
      if (y.size() == 0 || weights[k] == 0) continue;
      if (mean.size() == 0) mean = VectorXd::Zero(y.size());
      mean += weights[k] * y;
      count += weights[k];
    }
  }
  if (count < 2) return result;
  mean /= count;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      const VectorXd& y = outputs[k * stride + side];
      if (y.size() == 0 || weights[k] == 0) continue;
      result.variance += weights[k] * (y - mean).squaredNorm() / (count - 1);
    }
  }
  if (!(result.variance > 0)) return result;
  std::vector<double> first, total, used;
  for (Index i = 0; i < p; ++i) {
    first.clear();
    total.clear();
    used.clear();
    for (std::size_t k = 0; k < n; ++k) {
      const VectorXd& A = outputs[k * stride];
      const VectorXd& B = outputs[k * stride + 1];
      const VectorXd& mixed = outputs[k * stride + 2 + static_cast<std::size_t>(i)];
      if (A.size() == 0 || B.size() == 0 || mixed.size() == 0 || weights[k] == 0) continue;
      first.push_back((B - mean).dot(mixed - A) / result.variance);
      total.push_back((A - mixed).squaredNorm() / (2 * result.variance));
      used.push_back(weights[k]);
    }
    const Mean S = meanOf(first, used), T = meanOf(total, used);
    result.first[i] = S.value;
    result.firstDeviation[i] = S.error;
    result.total[i] = T.value;
    result.totalSd[i] = T.error;
  }
  return result;
}

void checkParameters(int parameters) {
  if (parameters < 1 || 2 * parameters > maxDimension) {
    throw std::invalid_argument(fmt::format("global sensitivity: {} parameters, must be 1 to {}",
                                            parameters, maxDimension / 2));
  }
}

/// How many base points these outputs are of.
std::size_t basePoints(const std::vector<VectorXd>& outputs, int parameters) {
  checkParameters(parameters);
  const auto stride = static_cast<std::size_t>(parameters) + 2;
  if (outputs.size() % stride != 0 || outputs.size() < 2 * stride) {
    throw std::invalid_argument(
        fmt::format("Sobol's indices: {} outputs, must be {} for each of at least 2 base points",
                    outputs.size(), stride));
  }
  return outputs.size() / stride;
}

void check(int parameters, const EnsembleOptions& options) {
  checkParameters(parameters);
  if (options.samples < 2) {
    throw std::invalid_argument(
        fmt::format("global sensitivity: {} samples, must be ≥ 2", options.samples));
  }
}

}  // namespace

VectorXd haltonPoint(std::uint64_t index, int dimension, std::uint64_t seed) {
  if (dimension < 1 || dimension > maxDimension) {
    throw std::invalid_argument(
        fmt::format("Halton: {} dimensions, must be 1 to {}", dimension, maxDimension));
  }
  VectorXd point(dimension);
  for (int d = 0; d < dimension; ++d) {
    const int base = primes()[static_cast<std::size_t>(d)];
    // a permutation of the digits, Fisher–Yates
    RandomStream random(seed, static_cast<std::uint64_t>(base));
    std::vector<int> digit(static_cast<std::size_t>(base));
    std::iota(digit.begin(), digit.end(), 0);
    for (std::size_t i = digit.size(); i-- > 1;) {
      std::swap(digit[i], digit[static_cast<std::size_t>(random.bits() % (i + 1))]);
    }
    // all digits are permuted, the leading zeros too: their tail is a number of its own
    double value = 0, scale = 1.0 / base;
    std::uint64_t rest = index;
    while (scale > 1e-17) {
      value += digit[static_cast<std::size_t>(rest % static_cast<std::uint64_t>(base))] * scale;
      rest /= static_cast<std::uint64_t>(base);
      scale /= base;
    }
    point[d] = std::min(value, 1 - 1e-15);
  }
  return point;
}

MorrisResult morris(const CubeModel& model, int parameters, const EnsembleOptions& options) {
  check(parameters, options);
  const Index p = parameters;
  constexpr double step = 2.0 / 3.0;
  std::vector<VectorXd> points;
  std::vector<std::vector<Index>> orders;
  for (int r = 0; r < options.samples; ++r) {
    RandomStream random(options.seed, static_cast<std::uint64_t>(r));
    VectorXd x(p);
    for (Index i = 0; i < p; ++i) x[i] = random.bits() % 2 == 0 ? 0.0 : 1.0 / 3.0;
    // half of the parameters start high and step down
    std::vector<bool> down(static_cast<std::size_t>(p));
    for (Index i = 0; i < p; ++i) {
      down[static_cast<std::size_t>(i)] = random.bits() % 2 == 0;
      if (down[static_cast<std::size_t>(i)]) x[i] += step;
    }
    std::vector<Index> order(static_cast<std::size_t>(p));
    std::iota(order.begin(), order.end(), Index{0});
    for (std::size_t i = order.size(); i-- > 1;) {
      std::swap(order[i], order[static_cast<std::size_t>(random.bits() % (i + 1))]);
    }
    points.push_back(x);
    for (const Index i : order) {
      x[i] += down[static_cast<std::size_t>(i)] ? -step : step;
      points.push_back(x);
    }
    orders.push_back(std::move(order));
  }
  const Runs runs = runAll(model, points, options);
  MorrisResult result;
  result.meanAbsolute.setConstant(p, std::nan(""));
  result.sd = result.meanAbsolute;
  result.runs = static_cast<int>(points.size());
  result.undefined = runs.undefined;
  result.complete = runs.complete;
  std::vector<std::vector<double>> effects(static_cast<std::size_t>(p));
  for (std::size_t r = 0; r < orders.size(); ++r) {
    for (std::size_t k = 0; k < orders[r].size(); ++k) {
      const std::size_t from = r * (orders[r].size() + 1) + k;
      const VectorXd& a = runs.outputs[from];
      const VectorXd& b = runs.outputs[from + 1];
      if (a.size() == 0 || b.size() == 0) continue;
      const Index i = orders[r][k];
      const double change = points[from + 1][i] - points[from][i];
      const VectorXd effect = (b - a) / change;
      const double size = std::sqrt(effect.squaredNorm() / static_cast<double>(effect.size()));
      effects[static_cast<std::size_t>(i)].push_back(std::copysign(size, effect.sum()));
    }
  }
  for (Index i = 0; i < p; ++i) {
    const auto& e = effects[static_cast<std::size_t>(i)];
    if (e.empty()) continue;
    std::vector<double> absolute = e;
    for (double& x : absolute) x = std::abs(x);
    result.meanAbsolute[i] = meanOf(absolute).value;
    result.sd[i] = meanOf(e).error * std::sqrt(static_cast<double>(e.size()));
  }
  return result;
}

VectorXd sobolPoint(std::uint64_t index, int parameters, std::uint64_t seed) {
  checkParameters(parameters);
  const std::uint64_t stride = static_cast<std::uint64_t>(parameters) + 2;
  const VectorXd both = haltonPoint(index / stride, 2 * parameters, seed);
  const std::uint64_t run = index % stride;
  if (run == 1) return both.tail(parameters);
  VectorXd point = both.head(parameters);
  if (run >= 2) {
    const auto i = static_cast<Index>(run - 2);
    point[i] = both[parameters + i];
  }
  return point;
}

SobolResult sobol(const CubeModel& model, int parameters, const EnsembleOptions& options) {
  check(parameters, options);
  const std::size_t count =
      static_cast<std::size_t>(options.samples) * (static_cast<std::size_t>(parameters) + 2);
  std::vector<VectorXd> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = sobolPoint(i, parameters, options.seed);
  const Runs runs = runAll(model, points, options);
  SobolResult result = sobolIndices(runs.outputs, parameters);
  result.complete = runs.complete;
  return result;
}

SobolResult sobolIndices(const std::vector<VectorXd>& outputs, int parameters) {
  const std::size_t n = basePoints(outputs, parameters);
  return weightedIndices(outputs, parameters, std::vector<double>(n, 1.0));
}

SobolIntervals bootstrapSobol(const std::vector<VectorXd>& outputs, int parameters, int replicates,
                              std::uint64_t seed, double confidence) {
  const std::size_t n = basePoints(outputs, parameters);
  if (replicates < 20) {
    throw std::invalid_argument(fmt::format("bootstrap: replicates = {} must be ≥ 20", replicates));
  }
  if (!(confidence > 0 && confidence < 1)) {
    throw std::invalid_argument(
        fmt::format("bootstrap: confidence = {} must be in (0, 1)", confidence));
  }
  const Index p = parameters;
  Eigen::MatrixXd first(replicates, p), total(replicates, p);
  for (Index r = 0; r < replicates; ++r) {
    RandomStream random(seed, static_cast<std::uint64_t>(r));
    std::vector<double> weights(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) weights[random.bits() % n] += 1;
    const SobolResult again = weightedIndices(outputs, p, weights);
    first.row(r) = again.first;
    total.row(r) = again.total;
  }
  SobolIntervals intervals{Eigen::MatrixX2d(p, 2), Eigen::MatrixX2d(p, 2)};
  const double tail = 0.5 * (1 - confidence);
  for (Index i = 0; i < p; ++i) {
    const std::vector<double> S(first.col(i).begin(), first.col(i).end());
    const std::vector<double> T(total.col(i).begin(), total.col(i).end());
    for (Index side = 0; side < 2; ++side) {
      intervals.first(i, side) = quantileOf(S, side == 0 ? tail : 1 - tail);
      intervals.total(i, side) = quantileOf(T, side == 0 ? tail : 1 - tail);
    }
  }
  return intervals;
}

}  // namespace info
