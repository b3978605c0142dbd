#include "info/design/cma_es.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "info/information/symmetric_eigen.h"
#include "info/parallel_for.h"
#include "info/probability/random_stream.h"

namespace info {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

EvolutionResult evolve(const std::function<double(const VectorXd&)>& cost,
                       const std::function<VectorXd(const VectorXd&)>& project,
                       const VectorXd& start, const EvolutionOptions& options) {
  const Index n = start.size();
  if (n == 0) throw std::invalid_argument("evolution: must have at least one variable");
  if (!(options.spread > 0)) throw std::invalid_argument("evolution: spread must be > 0");
  if (options.generations < 0 || options.population < 0) {
    throw std::invalid_argument("evolution: generations and population must be ≥ 0");
  }
  const auto dim = static_cast<double>(n);
  const int lambda = options.population > 0 ? std::max(options.population, 4)
                                            : std::max(8, 4 + static_cast<int>(3 * std::log(dim)));
  const int mu = lambda / 2;
  VectorXd weights(mu);
  for (int i = 0; i < mu; ++i) weights[i] = std::log((lambda + 1) / 2.0) - std::log(i + 1.0);
  weights /= weights.sum();
  const double mass = 1 / weights.squaredNorm();
  const double c_sigma = (mass + 2) / (dim + mass + 5);
  const double damping = 1 + 2 * std::max(0.0, std::sqrt((mass - 1) / (dim + 1)) - 1) + c_sigma;
  const double c_c = (4 + mass / dim) / (dim + 4 + 2 * mass / dim);
  const double c_1 = 2 / ((dim + 1.3) * (dim + 1.3) + mass);
  const double c_mu = std::min(1 - c_1, 2 * (mass - 2 + 1 / mass) / ((dim + 2) * (dim + 2) + mass));
  const double expected = std::sqrt(dim) * (1 - 1 / (4 * dim) + 1 / (21 * dim * dim));

  VectorXd mean = project(start);
  double sigma = options.spread;
  MatrixXd C = MatrixXd::Identity(n, n);
  VectorXd path_c = VectorXd::Zero(n), path_sigma = path_c;
  EvolutionResult result;
  result.x = mean;
  result.cost = cost(mean);
  result.evaluations = 1;
  if (!std::isfinite(result.cost)) result.cost = std::numeric_limits<double>::infinity();

  MatrixXd steps(n, lambda);
  std::vector<VectorXd> inside(static_cast<std::size_t>(lambda));
  std::vector<double> costs(inside.size()), ranked(inside.size());
  std::vector<std::size_t> order(inside.size());
  for (int generation = 0; generation < options.generations; ++generation) {
    // x = mean + σ B D z with C = B D² Bᵀ
    const auto eigen = symmetricEigen(C);
    const VectorXd D = eigen.values.cwiseMax(1e-20).cwiseSqrt();
    const MatrixXd& B = eigen.vectors;
    parallelFor(lambda, options.threads, [&](int i) {
      const auto si = static_cast<std::size_t>(i);
      RandomStream random(options.seed, static_cast<std::uint64_t>(generation) *
                                                static_cast<std::uint64_t>(lambda) +
                                            static_cast<std::uint64_t>(i));
      VectorXd z(n);
      for (Index k = 0; k < n; ++k) z[k] = random.normal();
      steps.col(i) = B * D.cwiseProduct(z);
      const VectorXd x = mean + sigma * steps.col(i);
      inside[si] = project(x);
      costs[si] = cost(inside[si]);
      if (!std::isfinite(costs[si])) costs[si] = std::numeric_limits<double>::infinity();
      ranked[si] = costs[si] + (x - inside[si]).squaredNorm();
    });
    result.evaluations += lambda;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ranked[a] < ranked[b]; });
    for (std::size_t i = 0; i < inside.size(); ++i) {
      if (costs[i] < result.cost) {
        result.cost = costs[i];
        result.x = inside[i];
      }
    }
    result.costs.push_back(result.cost);
    if (options.progress && !options.progress(generation + 1, result.cost)) {
      result.stopped = true;
      break;
    }

    // the mean moves to the better half; the paths remember where it went
    VectorXd step = VectorXd::Zero(n);
    for (int i = 0; i < mu; ++i) {
      step += weights[i] * steps.col(static_cast<Index>(order[static_cast<std::size_t>(i)]));
    }
    mean += sigma * step;
    const VectorXd white = B * (B.transpose() * step).cwiseQuotient(D);
    path_sigma = (1 - c_sigma) * path_sigma + std::sqrt(c_sigma * (2 - c_sigma) * mass) * white;
    const double length = path_sigma.norm();
    const double settled = 1 - std::pow(1 - c_sigma, 2 * (generation + 1));
    const bool steady = length / std::sqrt(settled) < (1.4 + 2 / (dim + 1)) * expected;
    path_c *= 1 - c_c;
    if (steady) path_c += std::sqrt(c_c * (2 - c_c) * mass) * step;
    C *= 1 - c_1 - c_mu + (steady ? 0 : c_1 * c_c * (2 - c_c));
    C += c_1 * path_c * path_c.transpose();
    for (int i = 0; i < mu; ++i) {
      const auto y = steps.col(static_cast<Index>(order[static_cast<std::size_t>(i)]));
      C += (c_mu * weights[i]) * y * y.transpose();
    }
    sigma *= std::exp(std::min(1.0, c_sigma / damping * (length / expected - 1)));
  }
  return result;
}

}  // namespace info
