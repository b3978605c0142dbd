#include "info/discovery/judgement/position_break.h"

#include <algorithm>
#include <cmath>

#include "discovery/judgement/held_out_trials.h"
#include "discovery/judgement/node_states.h"
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

// The latent force at a node, and the position of its axis there.
struct Visit {
  double position, force;
};

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

PositionBreak breakAt(const std::vector<Visit>& nodes, double position, bool above, double width,
                      double least) {
  PositionBreak found{.position = position, .above = above};
  Side near, far;
  std::size_t beyond = 0;
  for (const Visit& node : nodes) {
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

// The position with the largest |z| among those of one axis.
// @param squares Σ d² of its force
PositionBreak largestBreak(const std::vector<Visit>& nodes, double squares) {
  PositionBreak best;
  if (nodes.empty() || !(squares > 0)) return best;
  const auto [low, high] =
      std::minmax_element(nodes.begin(), nodes.end(),
                          [](const Visit& a, const Visit& b) { return a.position < b.position; });
  const double from = low->position, range = high->position - from;
  const double least = kLeastSpread * kLeastSpread * squares / static_cast<double>(nodes.size());
  for (int k = 1; k < kThresholds; ++k)
    for (const bool above : {true, false}) {
      const PositionBreak found =
          breakAt(nodes, from + k * range / kThresholds, above, kBeside * range, least);
      if (std::abs(found.z) > std::abs(best.z)) best = found;
    }
  best.margin = kMargin * range;
  return best;
}

std::optional<PositionBreak> breakOf(const DiscoveryProblem& data, const Options& options,
                                     const Whitening& sds) {
  const std::vector<int> trials = fittedTrials(data, options);
  Search search(data, trials, options, sds, [](const std::string&) {});
  const auto tracked = search.tracked({}, nominalValues(data));
  if (!tracked) return {};
  const NodeStates states = statesAtNodes(*tracked->likelihood, tracked->fit);
  PositionBreak best;
  for (std::size_t axis = 0; axis < states.numAxes; ++axis) {
    const std::vector<VectorXd> positions = states.positions(axis);
    std::vector<Visit> nodes;
    double squares = 0;
    for (std::size_t t = 0; t < trials.size(); ++t) {
      const VectorXd force =
          onAxis(tracked->likelihood->force(t, tracked->fit), axis, states.numAxes);
      squares += force.squaredNorm();
      for (Index k = 1; k < force.size(); ++k) nodes.push_back({positions[t][k], force[k]});
    }
    PositionBreak found = largestBreak(nodes, squares);
    found.axis = axis;
    if (std::abs(found.z) > std::abs(best.z)) best = found;
  }
  if (std::abs(best.z) < kStandardErrors) return {};
  return best;
}

}  // namespace

std::optional<PositionBreak> positionBreak(const DiscoveryProblem& data, const Options& options,
                                           const Verdict& verdict) {
  if (verdict.noise.usesAll()) return breakOf(data, options, verdict.sds);
  return breakOf(SelectedSamples(data, verdict.noise.kept), options, verdict.sds);
}

}  // namespace info::discover
