#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bio/path/surface/chain.h"
#include "bio/skeleton/rigid_motion.h"

namespace bio {

/// How many postures a chain keeps at most.
inline constexpr std::size_t maxChainStarts = 256;

/// Where a chain's surfaces are in the frame in which its ends are given.
using ChainPlacements = std::array<Placement<double>, maxChain>;

/// The ends of a chain as each member sees them, P and Q one after the other: what tells one
/// posture from another. 6 numbers for each member [m].
using ChainEnds = std::array<float, 6 * maxChain>;
ChainEnds chainEnds(std::size_t count, const ChainPlacements& X_GC, const Eigen::Vector3d& P,
                    const Eigen::Vector3d& Q);

/// Contacts of a chain in some postures, from which the search in any other starts.
///
/// The start is the kept posture whose ends lie nearest (the sum of squares over chainEnds), found
/// in a k-d tree. Its contacts are then moved to first order with the ends and with the members
/// against each other (ChainChanges::shifts): Newton's first step, without a geodesic walked.
class ChainStarts {
 public:
  /// A posture with its taut string.
  struct Known {
    ChainPlacements X_GC;
    Eigen::Vector3d P, Q;
    ChainPath taut;
    ChainMemory memory;
  };
  /// Where a search starts: the contacts kept, and as they should be in the posture.
  struct Start {
    const ChainMemory* kept = nullptr;
    ChainMemory moved;
  };

  /// @param postures  at least one
  /// @param count  members of the chain
  /// @param inOneSegment  whether they never move against each other
  ChainStarts(std::size_t count, bool inOneSegment, const std::vector<Known>& postures);

  /// Allocates nothing.
  Start startFor(std::span<const ChainObject> objects, const ChainPlacements& X_GC,
                 const Eigen::Vector3d& P, const Eigen::Vector3d& Q) const;

 private:
  static constexpr std::size_t maxMotions = 6 * maxChain;  // of P, Q and three members
  using Motion = std::array<float, maxMotions>;
  struct Split {
    std::size_t number = 0;  ///< of the ends
    float value = 0;
  };
  struct Nearest {
    std::size_t start = 0;
    float square = 1e30f;
  };

  void arrange(std::vector<std::size_t>& order, std::size_t first, std::size_t last,
               const std::vector<ChainEnds>& ends);
  void descend(const ChainEnds& ends, std::size_t first, std::size_t last, Nearest& best) const;
  Motion motionFrom(std::size_t start, const ChainEnds& ends, const ChainPlacements& X_GC) const;
  void addChanges(const Known& posture);

  std::size_t count_ = 0, numMotions_ = 0;
  std::vector<ChainMemory> starts_;       // in the order of the tree
  std::vector<ChainEnds> ends_;           // of each
  std::vector<Split> splits_;             // of the tree, at the middle of what it halves
  std::vector<Placement<double>> apart_;  // of each, the members but the first seen from the first
  std::vector<float> changes_;            // of each, for every motion and member: x, u, arc and a 0
};

}  // namespace bio
