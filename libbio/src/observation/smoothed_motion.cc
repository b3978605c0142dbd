#include "bio/observation/smoothed_motion.h"

#include <fmt/format.h>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace bio {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

void check(const std::vector<double>& times, const VectorXd& values, double cutoff,
           double spacing) {
  if (times.size() < 4 || static_cast<Index>(times.size()) != values.size()) {
    throw std::invalid_argument(
        fmt::format("smoothing: {} times and {} values, must be as many, "
                    "and at least 4",
                    times.size(), values.size()));
  }
  if (!values.allFinite()) throw std::invalid_argument("smoothing: a value is not finite");
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (!(times[k] > times[k - 1])) {
      throw std::invalid_argument(
          fmt::format("smoothing: time {} s after {} s, must rise", times[k], times[k - 1]));
    }
  }
  if (!(cutoff > 0 && spacing > 0 && 2 * cutoff * spacing < 1)) {
    throw std::invalid_argument(
        fmt::format("smoothing: cutoff {} Hz and spacing {} s, 2 f Δ must lie between 0 and 1",
                    cutoff, spacing));
  }
}

}  // namespace

SmoothedMotion smoothed(const std::vector<double>& times, const VectorXd& values, double cutoff,
                        double spacing) {
  check(times, values, cutoff, spacing);
  const double first = times.front();
  const auto n = std::max<Index>(
      4, static_cast<Index>(std::ceil((times.back() - first) / spacing - 1e-9)) + 1);
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd right = VectorXd::Zero(n);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double x = (times[k] - first) / spacing;
    const auto j = std::clamp<Index>(static_cast<Index>(x), 0, n - 2);
    const double w = std::clamp(x - static_cast<double>(j), 0.0, 1.0);
    const double y = values[static_cast<Index>(k)];
    entries.emplace_back(j, j, (1 - w) * (1 - w));
    entries.emplace_back(j, j + 1, (1 - w) * w);
    entries.emplace_back(j + 1, j, (1 - w) * w);
    entries.emplace_back(j + 1, j + 1, w * w);
    right[j] += (1 - w) * y;
    right[j + 1] += w * y;
  }
  const double penalty = std::pow(2 * std::sin(std::numbers::pi * cutoff * spacing), -6);
  constexpr double third[4] = {-1, 3, -3, 1};
  for (Index j = 0; j + 3 < n; ++j) {
    for (Index a = 0; a < 4; ++a) {
      for (Index b = 0; b < 4; ++b)
        entries.emplace_back(j + a, j + b, penalty * third[a] * third[b]);
    }
  }
  Eigen::SparseMatrix<double> system(n, n);
  system.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(system);
  SmoothedMotion result;
  result.values = factors.solve(right);
  result.speeds.resize(n);
  for (Index j = 0; j < n; ++j) {
    const Index before = std::max<Index>(0, j - 1), behind = std::min(n - 1, j + 1);
    result.speeds[j] = (result.values[behind] - result.values[before]) /
                       (spacing * static_cast<double>(behind - before));
    result.times.push_back(first + spacing * static_cast<double>(j));
  }
  return result;
}

}  // namespace bio
