#include "info/estimation/multi_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "info/parallel_for.h"
#include "info/probability/random_stream.h"

namespace info {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double agreement = 1e-3;  // nats

}  // namespace

MultiStart estimateFromStarts(const LeastSquares& problem, const VectorXd& scale,
                              const MultiStartOptions& options) {
  if (options.starts < 1) {
    throw std::invalid_argument(fmt::format("starts = {} must be ≥ 1", options.starts));
  }
  if (!(options.spread > 0 && std::isfinite(options.spread))) {
    throw std::invalid_argument(fmt::format("spread = {} must be > 0", options.spread));
  }
  const VectorXd own = problem.start();
  if (scale.size() != own.size() || !(scale.array() >= 0).all() || !scale.allFinite()) {
    throw std::invalid_argument(
        fmt::format("scale of {} parameters must be {} finite values ≥ 0", own.size(), own.size()));
  }
  for (const VectorXd& one : options.further) {
    if (one.size() != own.size()) {
      throw std::invalid_argument(
          fmt::format("start of {} parameters must be {}", one.size(), own.size()));
    }
  }
  const std::size_t n = static_cast<std::size_t>(options.starts) + options.further.size();
  MultiStart result;
  result.outcomes.resize(n);
  std::vector<std::optional<Estimate>> estimates(n);
  parallelFor(static_cast<int>(n), options.threads, [&](int i) {
    StartOutcome& outcome = result.outcomes[static_cast<std::size_t>(i)];
    outcome.start = own;
    if (i >= options.starts) {
      outcome.start = options.further[static_cast<std::size_t>(i - options.starts)];
    } else if (i > 0) {
      RandomStream random(options.seed, static_cast<std::uint64_t>(i));
      for (Index j = 0; j < own.size(); ++j) {
        const Parameter& parameter = problem.parameters()[static_cast<std::size_t>(j)];
        const double drawn = own[j] + options.spread * scale[j] * (2 * random.uniform() - 1);
        outcome.start[j] = std::clamp(drawn, parameter.lower, parameter.upper);
      }
    }
    outcome.cost = std::numeric_limits<double>::infinity();
    try {
      Estimate found = estimate(problem, outcome.start, options.estimate);
      outcome.parameters = found.parameters;
      outcome.cost = found.cost;
      outcome.converged = found.converged;
      outcome.why = describe(found.why);
      estimates[static_cast<std::size_t>(i)] = std::move(found);
    } catch (const std::domain_error& error) {
      outcome.parameters = outcome.start;
      outcome.why = error.what();
    }
  });

  std::size_t best = 0;
  for (std::size_t i = 1; i < n; ++i) {
    const StartOutcome &a = result.outcomes[i], &b = result.outcomes[best];
    if (!estimates[best] ||
        (estimates[i] &&
         (a.converged != b.converged ? a.converged : a.cost < b.cost - agreement))) {
      if (estimates[i]) best = i;
    }
  }
  if (!estimates[best]) throw std::domain_error(result.outcomes.front().why);
  result.best = std::move(*estimates[best]);
  for (const StartOutcome& outcome : result.outcomes) {
    result.agreeing += std::abs(outcome.cost - result.best.cost) <= agreement;
  }
  return result;
}

}  // namespace info
