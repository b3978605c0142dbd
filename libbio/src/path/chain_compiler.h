#pragma once

#include <vector>

#include "bio/path/compiled_path.h"

namespace bio {

/// A chain of the surfaces of a span, and what its author should know.
struct CompiledChain {
  PathChain chain;
  std::vector<std::size_t> endInside;  ///< members inside of which an end lies in some posture
  int numPostures = 0;                 ///< in which the path was followed
  int numNotFound = 0;                 ///< of those, without a taut string
};

/// Prepares a span for path_chain.h.
///
/// Each surface's hint follows from its quadrant, "all" from the shortest way, in the nearest of
/// the postures in which the chord reaches it. Of several surfaces the order is the one in which
/// the taut string is shortest and passes through none, in the postures in which the chord cuts
/// most of them. From there the path is followed from posture to posture, always on from the
/// nearest one, so that it keeps its way as long as there is one that does not pass
/// far beyond its objects' named sides; then it is decided anew, and the length jumps.
/// @param postures  those in which the span occurs, nearest to the default first; at least one
/// @throws UnsupportedWrap more than maxChain surfaces, no taut string in any posture
CompiledChain compileChain(const CompiledPath& path, const PathSpan& span,
                           const std::vector<const Posture*>& postures);

}  // namespace bio
