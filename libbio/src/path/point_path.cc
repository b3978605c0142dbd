#include "bio/path/point_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace bio {

PointPath::PointPath(const ArticulatedTree& tree, const std::vector<Station>& stations) {
  if (stations.size() < 2) {
    throw std::invalid_argument(
        fmt::format("a path has {} points, must have 2 or more", stations.size()));
  }
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!stations[i].p_S.allFinite()) {
      throw std::invalid_argument(fmt::format("point {} of a path must be finite", i + 1));
    }
  }
  std::set<int> support;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const Station &a = stations[i], &b = stations[i + 1];
    SegmentChain chain(tree, a.segment, b.segment);
    if (chain.steps().empty()) {
      constantLength_ += (b.p_S - a.p_S).norm();
      continue;
    }
    support.insert(chain.support().begin(), chain.support().end());
    pieces_.push_back({a, b, chain, chain.support()});
  }
  support_.assign(support.begin(), support.end());
  for (Piece& piece : pieces_) {
    for (int& slot : piece.slots) {
      const auto at = std::lower_bound(support_.begin(), support_.end(), slot);
      slot = static_cast<int>(at - support_.begin());
    }
    piece.chain.renumber(support_);
  }
}

}  // namespace bio
