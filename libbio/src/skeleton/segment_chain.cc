#include "bio/skeleton/segment_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace bio {
namespace {

/// Mobilities from the ground to a segment, inside out.
std::vector<int> wayTo(const ArticulatedTree& tree, int segment) {
  const int count = static_cast<int>(tree.segments().size());
  if (segment < 0 || segment >= count) {
    throw std::invalid_argument(fmt::format("segment {}, must be 0 to {}", segment, count - 1));
  }
  std::vector<int> way;
  for (int m = tree.mobilityOf(segment); m >= 0;) {
    way.push_back(m);
    m = tree.mobilities()[static_cast<std::size_t>(m)].parent;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

int slotOf(const std::vector<int>& support, int coordinate) {
  const auto at = std::lower_bound(support.begin(), support.end(), coordinate);
  if (at == support.end() || *at != coordinate) {
    throw std::invalid_argument(
        fmt::format("coordinate {} moves the chain but is not in its support", coordinate));
  }
  return static_cast<int>(at - support.begin());
}

}  // namespace

SegmentChain::SegmentChain(const ArticulatedTree& tree, int from, int to) {
  const std::vector<int> a = wayTo(tree, from), b = wayTo(tree, to);
  const auto apart = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto append = [&](int m, double sign) {
    const bool bends = !tree.mobilities()[static_cast<std::size_t>(m)].hasFixedScrew;
    steps_.push_back({m, 0, sign, bends});
  };
  for (auto m = a.end(); m != apart.first;) append(*--m, -1);
  for (auto m = apart.second; m != b.end(); ++m) append(*m, 1);
  const auto coordinateOf = [&](const Step& step) {
    return tree.mobilities()[static_cast<std::size_t>(step.mobility)].coordinate;
  };
  for (const Step& step : steps_) support_.push_back(coordinateOf(step));
  std::sort(support_.begin(), support_.end());
  support_.erase(std::unique(support_.begin(), support_.end()), support_.end());
  for (Step& step : steps_) step.slot = slotOf(support_, coordinateOf(step));
}

void SegmentChain::renumber(const std::vector<int>& larger) {
  for (Step& step : steps_) {
    step.slot = slotOf(larger, support_[static_cast<std::size_t>(step.slot)]);
  }
  support_ = larger;
}

}  // namespace bio
