#include "bio/design/input_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "info/design/cma_es.h"
#include "info/parallel_for.h"
#include "model/require.h"

namespace bio {

using Eigen::VectorXd;

namespace {
constexpr int population = 16;
}

InputSearch::InputSearch(const DesignInputs& inputs, const DesignSearchSettings& settings,
                         double best, double further, DesignSearchRecord& record)
    : inputs_(inputs),
      settings_(settings),
      best_(best),
      planned_(settings.candidates + 1 + population * settings.generations + further),
      record_(record) {
  require(settings.candidates >= 0 && settings.generations >= 0 && settings.iterations >= 0,
          "candidates, generations and iterations must be ≥ 0");
}

void InputSearch::note(const VectorXd& x, bool isPossible, double cost) {
  const std::lock_guard lock(mutex_);
  ++record_.runs;
  if (!isPossible) ++record_.impossible;
  if (cost < best_) {
    best_ = cost;
    bestInputs_ = x;
    record_.costs.push_back(cost);
    record_.foundAt.push_back(record_.runs);
  }
  if (settings_.progress && !settings_.progress(std::min(1.0, record_.runs / planned_))) {
    stop_ = record_.stopped = true;
  }
}

VectorXd InputSearch::evolve(const std::function<double(const VectorXd&)>& costOf) const {
  std::vector<VectorXd> candidates(static_cast<std::size_t>(settings_.candidates) + 1,
                                   inputs_.own());
  std::vector<double> costs(candidates.size());
  info::parallelFor(static_cast<int>(candidates.size()), settings_.threads, [&](int i) {
    const auto si = static_cast<std::size_t>(i);
    if (i > 0) candidates[si] = inputs_.random(settings_.seed, static_cast<std::uint64_t>(i));
    costs[si] = costOf(candidates[si]);
  });
  const auto first = std::min_element(costs.begin(), costs.end());
  VectorXd x = candidates[static_cast<std::size_t>(first - costs.begin())];
  if (settings_.generations == 0 || stop_) return x;
  info::EvolutionOptions options;
  options.generations = settings_.generations;
  options.population = population;
  options.spread = 0.2;
  options.seed = settings_.seed;
  options.threads = settings_.threads;
  options.progress = [&](int, double) { return !stop_; };
  const auto project = [&](const VectorXd& inputs) { return inputs_.profiles().project(inputs); };
  return info::evolve(costOf, project, x, options).x;
}

std::vector<double> samplingTimes(double start, double duration, double period) {
  require(period >= 1e-6 * duration && period <= duration,
          fmt::format(
              "period of the measurements = {} s, must be a millionth of the duration to all of it",
              period));
  const auto count = static_cast<std::size_t>(std::floor(duration / period + 1e-6));
  std::vector<double> times;
  for (std::size_t k = 0; k <= count; ++k) times.push_back(start + static_cast<double>(k) * period);
  return times;
}

}  // namespace bio
