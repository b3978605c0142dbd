#include "info/discovery/judgement/position_break.h"

#include <algorithm>
#include <cmath>

#include "discovery/judgement/held_out_trials.h"
#include "discovery/likelihood/selected_samples.h"
#include "discovery/search/search.h"

namespace info::discover {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kBeside = 0.1;    // width of each side, as a share of the visited range
constexpr double kMargin = 0.025;  // of a position, as a share of the same
constexpr int kThresholds = 100;   // positions tried
constexpr int kFewest = 4;         // nodes on each side
constexpr double kMostBeyond = 0.4;
constexpr double kStandardErrors = 5;
// So many nodes count as one: 1 + 2 Σ e^{−k·0.05/0.08} = 3.3 for nodes every 0.05 s (D6).
constexpr double kCorrelated = 3;
// Least standard deviation on one side, as a share of the force's rms value.
constexpr double kLeastSpread = 0.2;

struct Node {
  double position, force;
};

// The measured position next to each node of the latent force.
std::vector<Node> nodesOf(const DiscoveryProblem& data, int trial, const VectorXd& force) {
  const std::vector<double>& times = data.times(trial);
  const std::vector<int>& outputs = data.outputOfSample(trial);
  std::vector<Node> nodes;
  for (Index k = 1; k < force.size(); ++k) {
    const double at = data.latentTimes(trial)[static_cast<std::size_t>(k)];
    auto i = std::lower_bound(times.begin(), times.end(), at) - times.begin();
    i = std::min<std::ptrdiff_t>(i, static_cast<std::ptrdiff_t>(times.size()) - 1);
    while (i > 0 && !outputs.empty() && outputs[static_cast<std::size_t>(i)] != 0) --i;
    nodes.push_back({data.measured(trial)[i], force[k]});
  }
  return nodes;
}

struct Side {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double variance() const { return std::max(0.0, squares / count - mean() * mean()); }
};

PositionBreak breakAt(const std::vector<Node>& nodes, double position, bool above, double width,
                      double least) {
  PositionBreak found{.position = position, .above = above};
  Side near, far;
  std::size_t beyond = 0;
  for (const Node& node : nodes) {
    const double distance = (above ? 1 : -1) * (node.position - position);
    if (distance > 0) ++beyond;
    if (distance > 0 && distance < width) far.add(node.force);
    if (distance <= 0 && distance > -width) near.add(node.force);
  }
  const double share = static_cast<double>(beyond) / static_cast<double>(nodes.size());
  if (std::min(near.count, far.count) < kFewest || share > kMostBeyond) return found;
  found.before = near.mean();
  found.beyond = far.mean();
  const double variance =
      (near.variance() + least) / near.count + (far.variance() + least) / far.count;
  found.z = (found.beyond - found.before) / std::sqrt(kCorrelated * variance);
  return found;
}

std::optional<PositionBreak> breakOf(const DiscoveryProblem& data, const Options& options,
                                     const Whitening& outputSd) {
  const std::vector<int> trials = fittedTrials(data, options);
  Search search(data, trials, options, outputSd, [](const std::string&) {});
  const auto fit = search.tracked({}, nominalValues(data));
  if (!fit) return {};
  std::vector<Node> nodes;
  double squares = 0;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const VectorXd force = search.likelihood().force(t, *fit);
    squares += force.squaredNorm();
    const auto more = nodesOf(data, trials[t], force);
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  if (nodes.empty() || !(squares > 0)) return {};
  const auto [low, high] =
      std::minmax_element(nodes.begin(), nodes.end(),
                          [](const Node& a, const Node& b) { return a.position < b.position; });
  const double from = low->position, range = high->position - from;
  const double least = kLeastSpread * kLeastSpread * squares / static_cast<double>(nodes.size());
  PositionBreak best;
  for (int k = 1; k < kThresholds; ++k)
    for (const bool above : {true, false}) {
      const PositionBreak one =
          breakAt(nodes, from + k * range / kThresholds, above, kBeside * range, least);
      if (std::abs(one.z) > std::abs(best.z)) best = one;
    }
  if (std::abs(best.z) < kStandardErrors) return {};
  best.margin = kMargin * range;
  return best;
}

}  // namespace

std::optional<PositionBreak> positionBreak(const DiscoveryProblem& data, const Options& options,
                                           const Verdict& verdict) {
  if (verdict.noise.usesAll()) return breakOf(data, options, verdict.outputSd);
  return breakOf(SelectedSamples(data, verdict.noise.kept), options, verdict.outputSd);
}

}  // namespace info::discover
